// A thin-plate smoothing spline on what a stiffer skin leaves (it must never see the skin's own curvature: it
// flattens).
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace striae::wound {

/// f(x) = a + b u + c v + sum_i w_i phi(|x - x_i|), phi(r) = r^2 ln r.
struct Spline {
  std::vector<Eigen::Vector2d> knots;
  Eigen::VectorXd weights;
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  [[nodiscard]] double At(double u, double v) const;
};

/// Through the weighted means of square blocks of the points, 150 at most; how closely is chosen by generalised
/// cross-validation (Wahba, Spline Models for Observational Data, 1990, ch. 4). Nothing for fewer than ten blocks.
std::optional<Spline> FitSpline(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights);

}  // namespace striae::wound
