// From absolute stripe orders to points and faces.
#pragma once

#include "core/calibration.h"
#include "core/image.h"
#include "core/surface.h"
#include "reconstruct/detail/ray_table.h"

namespace striae::reconstruct::detail {

/// Depth z (mm) of every pixel whose absolute order is not NaN, in the place of the order; NaN where the ray and the
/// light do not meet between `near_mm` and `far_mm`. `uncertainty` is of the order (stripes) before, of the depth (mm,
/// along the pixel's ray) after.
ImageF Triangulate(ImageF order, const Calibration& calibration, const RayTable& table, double near_mm, double far_mm,
                   ImageF& uncertainty);

/// What becomes the points' properties.
struct PointImages {
  ImageF depth, uncertainty, modulation;
  ImageRgb colour;
};

/// Points in row-major order of their pixels, and two triangles for every 2 x 2 of neighbours (one where three are
/// valid). Sides that run deeper than grazing incidence of 75 degrees explains are cut.
Surface BuildSurface(PointImages images, const Calibration& calibration, const RayTable& table, bool faces);

}  // namespace striae::reconstruct::detail
