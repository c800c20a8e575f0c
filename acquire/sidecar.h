// An XMP file beside a photograph that says whose it is: for people and programs that look at the folder and not at the
// study. The photograph itself is never touched.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.h"
#include "core/study.h"

namespace striae::acquire {

/// What stands in it besides the capture's own fields. A pseudonym and ids only, never a name.
struct SidecarContext {
  std::string protocol, pseudonym, visit;
};

/// The XMP packet (ISO 16684-1) without its padding: dc:identifier and xmpMM:DocumentID name the capture, the rest
/// stands in the namespace "urn:striae:xmp:1#": Protocol, Subject, Visit, Session, Capture, Role, BodySite, Laterality,
/// SHA256, FileName. Fields that are empty are left out. The same capture gives the same bytes.
Result<std::string> MakeSidecar(const Capture& capture, const SidecarContext& context);

/// "DSC_0001.JPG.xmp" for "DSC_0001.JPG": the whole name, because a JPEG and a NEF share its first part.
std::filesystem::path SidecarPath(const std::filesystem::path& photograph);

/// Whether these bytes are a sidecar that MakeSidecar wrote, and may be written anew.
bool IsOwnSidecar(const std::string& text);

}  // namespace striae::acquire
