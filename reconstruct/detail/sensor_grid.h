// What a SensorSurface is made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/calibration.h"
#include "core/image.h"
#include "reconstruct/detail/ray_table.h"
#include "reconstruct/sensor_surface.h"

namespace striae::reconstruct {

/// What becomes the points' properties; all of the sensor's size, depth (mm) NaN where there is no point.
struct PointImages {
  ImageF depth, uncertainty, modulation;
  ImageRgb colour;
};

/// Points in row-major order of their pixels, and two triangles for every 2 x 2 of neighbours (one where three are
/// valid). Sides that run deeper than grazing incidence of 75 degrees explains are cut.
struct SensorSurface::Grid {
  Grid(PointImages of, const CameraModel& camera, detail::RayTable rays, bool with_faces);

  [[nodiscard]] int width() const { return images.depth.width(); }
  [[nodiscard]] int height() const { return images.depth.height(); }

  PointImages images;
  detail::RayTable table;
  Image<std::uint8_t> triangles;                     ///< of every square of neighbours, a bit each; empty without faces
  std::vector<std::size_t> first_point, first_face;  ///< of every row, and the number of all
};

}  // namespace striae::reconstruct
