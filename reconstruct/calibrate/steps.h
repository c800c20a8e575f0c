// The steps of a calibration: which photograph was taken at which position of the slide (CONTRACT "Steps").
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace striae::reconstruct {

struct CalibrationStep {
  std::string image;       ///< path as written, relative to the csv
  double position_mm = 0;  ///< grows away from the camera
};

/// Reads `image,position_mm` lines under that header. kBadFile with the line: wrong header, a position that is no
/// number, the same photograph or the same position twice.
Result<std::vector<CalibrationStep>> ParseSteps(std::string_view csv);

}  // namespace striae::reconstruct
