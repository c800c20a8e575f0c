#include "acquire/sidecar.h"

#include <exception>

#include <exiv2/exiv2.hpp>

namespace striae::acquire {
namespace {

constexpr const char* kNamespace = "urn:striae:xmp:1#";

/// Exiv2's table of namespaces belongs to the process.
void RegisterOnce() {
  static const bool registered = [] {
    Exiv2::XmpParser::initialize();
    Exiv2::XmpProperties::registerNs(kNamespace, "striae");
    return true;
  }();
  (void)registered;
}

/// XML has no sign for most control characters, whatever escapes them; a file name may hold any.
std::string Printable(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '_';
  }
  return text;
}

}  // namespace

Result<std::string> MakeSidecar(const Capture& capture, const SidecarContext& context) {
  try {
    RegisterOnce();
    Exiv2::LogMsg::setLevel(Exiv2::LogMsg::mute);
    Exiv2::XmpData xmp;
    const auto put = [&](const char* key, const std::string& value) {
      if (!value.empty()) xmp[key] = Printable(value);
    };
    const std::string id = capture.id.ToString();
    put("Xmp.dc.identifier", "urn:uuid:" + id);
    put("Xmp.xmpMM.DocumentID", "urn:uuid:" + id);
    put("Xmp.striae.Protocol", context.protocol);
    put("Xmp.striae.Subject", context.pseudonym);
    put("Xmp.striae.Visit", context.visit);
    put("Xmp.striae.Session", capture.session.ToString());
    put("Xmp.striae.Capture", id);
    put("Xmp.striae.Role", capture.role.ToString());
    put("Xmp.striae.BodySite", capture.body_site);
    put("Xmp.striae.Laterality", std::string(ToString(capture.laterality)));
    put("Xmp.striae.SHA256", capture.sha256.ToString());
    put("Xmp.striae.FileName", capture.file_name);
    std::string packet;
    constexpr auto kFormat = Exiv2::XmpParser::omitPacketWrapper | Exiv2::XmpParser::useCompactFormat;
    if (Exiv2::XmpParser::encode(packet, xmp, kFormat) != 0) {
      return Fail(ErrorCode::kInternal, "Exiv2 could not write the XMP of " + capture.file_name);
    }
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + packet + (packet.ends_with('\n') ? "" : "\n");
  } catch (const std::exception& exception) {
    return Fail(ErrorCode::kInternal,
                "Exiv2 could not write the XMP of " + capture.file_name + " (" + exception.what() + ")");
  }
}

std::filesystem::path SidecarPath(const std::filesystem::path& photograph) {
  std::filesystem::path path = photograph;
  path += ".xmp";
  return path;
}

bool IsOwnSidecar(const std::string& text) { return text.find(kNamespace) != std::string::npos; }

}  // namespace striae::acquire
