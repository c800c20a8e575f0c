// The plain point sets that the parts of the head analysis hand to each other, in mm and the camera's frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/surface.h"

namespace striae::head::detail {

using Points = std::vector<Eigen::Vector3f>;

/// Points with their standard uncertainty along the ray, mm, and their pixel; same length.
struct Thinned {
  Points point;
  std::vector<float> sd_mm;
  std::vector<Eigen::Vector2f> pixel;  ///< mean (col, row); NaN without a sensor grid
  [[nodiscard]] std::size_t size() const { return point.size(); }
};

/// Points with unit normals towards the camera their standard uncertainty, mm, and their pixel; same length.
struct Cloud {
  Points point, normal;
  std::vector<float> sd_mm;
  std::vector<Eigen::Vector2f> pixel;  ///< as Thinned
  [[nodiscard]] std::size_t size() const { return point.size(); }
};

/// For surfaces that do not say how uncertain their points are.
inline constexpr float kUnsaidSdMm = 0.3F;

Cloud Select(const Cloud& cloud, const std::vector<std::uint32_t>& indices);

/// About one point every `spacing_mm`: means over square blocks of the sensor grid (over voxels where there is none),
/// which also lowers the noise. Blocks across a depth step keep their nearer side. Order: rows of blocks (voxels). The
/// uncertainty is the block's mean one: what the Fourier stage gets wrong, neighbours get wrong together.
Thinned Thin(const Surface& surface, double spacing_mm);

}  // namespace striae::head::detail
