// What a calibration's own uncertainty does to the depth of a surface.
#pragma once

#include <optional>
#include <vector>

#include "core/calibration.h"

namespace striae::reconstruct {

/// Standard uncertainty of depth along the ray, mm; of points spread over a surface. It moves neighbours together: it
/// matters for distances and for scale, not for the shape of what is small against the field.
struct CalibrationDepthUncertainty {
  double median_mm = 0, largest_mm = 0;
};

struct PixelDepth {
  double col = 0, row = 0;  ///< sensor pixel
  double depth_mm = 0;
};

/// sqrt(J C J^T) with the calibration's covariance C and J, by central differences, of the depth at which a pixel's ray
/// meets the stripe that was seen there. nullopt where the calibration carries no covariance, or none of the points can
/// be seen by it.
std::optional<CalibrationDepthUncertainty> DepthUncertaintyOf(const Calibration& calibration,
                                                              const std::vector<PixelDepth>& points);

}  // namespace striae::reconstruct
