// One check of the rig on an artefact: photographs or surfaces in, figures and verdict out.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/calibration.h"
#include "core/result.h"
#include "core/study.h"
#include "core/surface.h"
#include "reconstruct/verify/verify.h"

namespace striae::app {

/// What is measured from, with what proves where it came from.
struct CheckInput {
  std::string file;
  Sha256 sha256;                      ///< of the file
  std::optional<Sha256> calibration;  ///< that the surface was made with; a PLY names it in its comments
  std::string body_serial;            ///< of a photograph with EXIF
  Surface surface;
};

struct CalibrationFile {
  Calibration calibration;
  Sha256 sha256;
};
Result<CalibrationFile> ParseCalibrationFile(std::span<const std::uint8_t> bytes, const std::string& name);

/// A PLY, or a photograph that is reconstructed with `calibration` (kUsage when that is missing).
Result<CheckInput> ReadCheckInput(const std::filesystem::path& file, const std::optional<CalibrationFile>& calibration);

struct CheckPlan {
  std::string kind;  ///< "plane", "ball", "distance"
  double diameter_mm = 0, distance_mm = 0;
  std::optional<RigRange> range;       ///< of the default tolerances; from the distance of the artefact when not given
  std::optional<double> tolerance_mm;  ///< for the main figures instead of the range's
  reconstruct::VerifyOptions options;
};

/// The figures of each input, the worst of each, and whether all keep the tolerances:
/// {"check", "passed", "range", "tolerances_mm": {name: limit}, "worst_mm": {name: signed value},
///  "inputs": [{"file", "sha256", "calibration_sha256", "passed", figures ...}]}. The names are "flatness"; "form" and
/// "size"; "spacing". An artefact that is not found in one input is an error.
Result<nlohmann::json> RunCheck(const std::vector<CheckInput>& inputs, const CheckPlan& plan);

/// The document in words, a line an input.
std::string CheckText(const nlohmann::json& document);

}  // namespace striae::app
