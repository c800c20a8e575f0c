// From absolute stripe orders to depth.
#pragma once

#include "core/calibration.h"
#include "core/image.h"
#include "reconstruct/detail/ray_table.h"

namespace striae::reconstruct::detail {

/// Depth z (mm) of every pixel whose absolute order is not NaN, in the place of the order; NaN where the ray and the
/// light do not meet between `near_mm` and `far_mm`. `uncertainty` is of the order (stripes) before, of the depth (mm,
/// along the pixel's ray) after.
ImageF Triangulate(ImageF order, const Calibration& calibration, const RayTable& table, double near_mm, double far_mm,
                   ImageF& uncertainty);

}  // namespace striae::reconstruct::detail
