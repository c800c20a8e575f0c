// Which points belong to an artefact, and what is left of their distances after rejection.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/outline.h"
#include "core/result.h"
#include "core/surface.h"

namespace striae::reconstruct::detail {

using Points = std::vector<std::uint32_t>;  ///< indices into a surface, ascending

/// Below this a fit says nothing.
inline constexpr std::size_t kFewestPoints = 500;

inline Eigen::Vector3d At(const Surface& surface, std::uint32_t index) {
  return surface.point_in_camera[index].cast<double>();
}

/// The points inside an outline; kOutlineOffSurface when there are fewer than kFewestPoints.
Result<Points> InOutline(const Surface& surface, const Outline& outline);

/// At most `count` of the points, evenly spread over their order.
Points Thin(const Points& points, std::size_t count);

/// The largest set of neighbours on the sensor (by sides) among `points`; all of them for a surface without a grid.
Points LargestConnected(const Surface& surface, const Points& points);

/// All points of the surface whose pixel lies within the convex hull of those of `points`; `points` without a grid.
Points InHullOf(const Surface& surface, const Points& points);

/// Deterministic numbers below a bound (std's distributions differ between libraries).
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : state_(seed) {}
  std::uint32_t Below(std::size_t bound);

 private:
  std::uint64_t state_;
};

/// Positions within `deviations` of those that stay when the `share` largest in amount are left out (rounded down).
std::vector<std::size_t> Kept(const std::vector<double>& deviations, double share);

double RangeOf(const std::vector<double>& values);
double SdOf(const std::vector<double>& values);

}  // namespace striae::reconstruct::detail
