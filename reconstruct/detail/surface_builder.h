// From absolute stripe orders to points and faces.
#pragma once

#include "core/calibration.h"
#include "core/image.h"
#include "core/surface.h"
#include "reconstruct/detail/ray_table.h"

namespace striae::reconstruct::detail {

/// Where pixels may lie, and what their stripe order is worth.
struct Triangulation {
  double near_mm = 0, far_mm = 0;  ///< depths outside are dropped
  /// Standard uncertainty of the order (stripes) is noise / amplitude / 2 pi, and this besides (in quadrature): what
  /// the Fourier window leaves of texture and shape, and what does not follow from the sensor's noise.
  double order_floor = 0;
  double noise = 0;  ///< of the amplitude's components
};

/// Depth z (mm) of every pixel whose absolute order is not NaN, in the place of the order; NaN where the ray and the
/// light do not meet within the limits. The amplitude's place is taken by the depth's standard uncertainty (mm).
ImageF Triangulate(ImageF order, const Calibration& calibration, const RayTable& table, const Triangulation& limits,
                   ImageF& amplitude);

/// What becomes the points' properties.
struct PointImages {
  ImageF depth, uncertainty, modulation;
  ImageRgb colour;
};

/// Points in row-major order of their pixels, and two triangles for every 2 x 2 of neighbours (one where three are
/// valid). Sides that run deeper than grazing incidence of 75 degrees explains are cut.
Surface BuildSurface(PointImages images, const Calibration& calibration, const RayTable& table, bool faces);

}  // namespace striae::reconstruct::detail
