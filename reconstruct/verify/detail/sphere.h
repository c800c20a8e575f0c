// Spheres: fitted, and found in a surface.
#pragma once

#include <optional>

#include "reconstruct/verify/detail/region.h"

namespace striae::reconstruct::detail {

struct Sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;
  [[nodiscard]] double Distance(const Eigen::Vector3d& p) const { return (p - centre).norm() - radius; }
  /// Whether the sight line through a point meets the sphere within `cap_rad` of the place that faces the camera.
  [[nodiscard]] bool FacesRay(const Eigen::Vector3d& p, double cap_rad) const;
};

/// Gauss-Newton on the radial distances from `start` (geometric least squares, centre and radius free).
Sphere FitSphere(const Surface& surface, const Points& points, Sphere start);

/// The ball of about `radius_mm` that most of `points` lie on, refined with its radius free: from each drawn point the
/// centre lies one radius behind the surface along its normal. Nothing where no normal can be taken.
std::optional<Sphere> FindSphere(const Surface& surface, const Points& points, double radius_mm, std::uint64_t seed);

}  // namespace striae::reconstruct::detail
