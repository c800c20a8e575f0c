// From absolute stripe orders to points and faces.
#pragma once

#include "core/calibration.h"
#include "core/image.h"
#include "core/surface.h"
#include "reconstruct/detail/ray_table.h"

namespace striae::reconstruct::detail {

/// Depth z (mm) of every pixel whose absolute order is not NaN; NaN where the ray and the light do not meet between
/// `near_mm` and `far_mm`.
ImageF Triangulate(ImageF order, const Calibration& calibration, const RayTable& table, double near_mm, double far_mm);

/// Points in row-major order of their pixels, and two triangles for every 2 x 2 of neighbours (one where three are
/// valid). Sides that run deeper than grazing incidence of 75 degrees explains are cut.
Surface BuildSurface(const ImageF& depth, ImageRgb colour, ImageF modulation, const Calibration& calibration,
                     const RayTable& table, bool faces);

}  // namespace striae::reconstruct::detail
