#include "core/target.h"

#include <cctype>
#include <cstdint>

namespace striae {
namespace {

std::uint32_t Crc32(const Uuid& uuid) {
  std::uint32_t crc = 0xffffffffU;
  for (const std::uint8_t byte : uuid.bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xedb88320U : 0U);
  }
  return ~crc;
}

}  // namespace

CharucoBoard BoardFor(RigRange range) {
  const std::string dictionary(kBoardDictionary);
  return range == RigRange::kSmall ? CharucoBoard{7, 5, 36, 27, dictionary} : CharucoBoard{7, 5, 52, 39, dictionary};
}

std::string SessionCode(const SessionId& session) {
  std::string code = session.ToString().substr(0, 8);
  for (char& c : code) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return code.substr(0, 4) + "-" + code.substr(4);
}

std::string DigitsOfSessionCode(std::string_view typed) {
  std::string digits;
  for (std::size_t i = 0; i < typed.size(); ++i) {
    if (typed[i] == '-' && i == 4) continue;
    const auto c = static_cast<unsigned char>(typed[i]);
    if (std::isxdigit(c) == 0) return {};
    digits += static_cast<char>(std::tolower(c));
  }
  return digits.size() == 8 ? digits : std::string();
}

int LabelMarkerId(const SessionId& session) {
  return static_cast<int>(Crc32(session.uuid()) % static_cast<std::uint32_t>(kLabelMarkers));
}

double DefaultLabelSideMm(RigRange range) { return range == RigRange::kSmall ? 40 : 100; }

Label LabelFor(const SessionId& session, double side_mm) {
  return {LabelMarkerId(session), side_mm, SessionCode(session)};
}

}  // namespace striae
