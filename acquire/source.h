// Where photographs come from. Card, folder and camera hand the same thing to the same ingest.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/hex.h"
#include "core/result.h"
#include "core/study.h"

namespace striae::acquire {

/// Whose photograph it is and what for. It is fixed BEFORE the shutter: a photograph that arrives without one is
/// quarantined and never given to whoever was treated last.
struct CaptureBinding {
  SubjectId subject;
  SessionId session;
  CaptureRole role;
  std::string body_site;
  Laterality laterality = Laterality::kUnspecified;
};

/// A photograph as it arrived, untouched.
struct IngestItem {
  std::vector<std::uint8_t> bytes;
  std::string file_name;  ///< as the camera named it, without folder; names repeat ("DSC_0001.JPG")
  std::string origin;     ///< where it came from, for a person: a path, or camera, folder and name
  std::optional<CaptureBinding> binding;
};

/// One after the other until there are no more. An error concerns the next photograph only where the source can go on.
class CaptureSource {
 public:
  virtual ~CaptureSource() = default;
  /// nullopt: the source is exhausted.
  virtual Result<std::optional<IngestItem>> Next() = 0;
};

}  // namespace striae::acquire
