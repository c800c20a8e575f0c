// A quadric in space as a height over the wound's frame: w + (a u + b v) w + c w^2 = c2(u, v), the branch through the
// ring. It covers planes, spheres, cylinders, cones and ellipsoids without the error that a polynomial height has.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace striae::wound {

/// Coordinates are already divided by the ring's radius, so that the prior below has a meaning.
struct Quadric {
  Eigen::Vector3d bend = Eigen::Vector3d::Zero();                            ///< a, b, c
  Eigen::Matrix<double, 6, 1> height = Eigen::Matrix<double, 6, 1>::Zero();  ///< 1, u, v, u^2, u v, v^2

  /// Nothing where the quadric has no sheet over (u, v).
  [[nodiscard]] std::optional<double> At(double u, double v) const;
};

/// Weighted least squares of the height (not algebraic), by Levenberg-Marquardt from the quadratic patch. `noise` is
/// the points' sd and `independent` the number of points that count as independent: a zero-mean prior of sd 0.5 on the
/// bend keeps small noisy rings from degenerating (there the result tends to the quadratic patch).
/// Nothing when no quadric has a sheet over every point.
std::optional<Quadric> FitQuadric(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights,
                                  double noise, double independent);

}  // namespace striae::wound
