#include "analysis/wound/detail/line.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace striae::wound {
namespace {

constexpr double kMadToSd = 1.4826;
constexpr double kCorner = 0.5;  // cosine of the turn beyond which a point is a corner that was meant

Polygon GaussianMeans(const Polygon& even, double sd_points) {
  const auto n = static_cast<std::ptrdiff_t>(even.size());
  const auto reach = std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(std::ceil(3 * sd_points)), n / 2);
  Polygon means;
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double mass = 0;
    for (std::ptrdiff_t d = -reach; d <= reach; ++d) {
      const double x = static_cast<double>(d) / sd_points, weight = std::exp(-x * x / 2);
      sum += weight * even[static_cast<std::size_t>((k + d + n) % n)];
      mass += weight;
    }
    means.push_back(sum / mass);
  }
  return means;
}

}  // namespace

LineStudy StudyLine(const Polygon& drawn) {
  LineStudy study;
  const std::size_t n = drawn.size();
  if (n < 8) return study;
  std::vector<double> off;
  double squares = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const auto& before = drawn[(k + n - 1) % n];
    const auto& after = drawn[(k + 1) % n];
    const Eigen::Vector2d chord = after - before;
    squares += chord.squaredNorm() / 4;
    if (!(chord.norm() > 0)) continue;
    const Eigen::Vector2d wide = drawn[(k + 2) % n] - drawn[(k + n - 2) % n];
    if (chord.dot(wide) < kCorner * chord.norm() * wide.norm()) continue;
    const Eigen::Vector2d foretold = (4 * (before + after) - drawn[(k + n - 2) % n] - drawn[(k + 2) % n]) / 6;
    const Eigen::Vector2d miss = drawn[k] - foretold;
    const Eigen::Vector2d across = Eigen::Vector2d(-wide.y(), wide.x()).normalized();
    off.push_back(std::abs(miss.dot(across)));
  }
  if (off.size() < 8) return study;
  const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
  std::nth_element(off.begin(), middle, off.end());
  study.roughness = kMadToSd * *middle / std::sqrt(1 + 34.0 / 36);  // variance of the point and of its prediction
  study.area_sd = study.roughness * std::sqrt(squares);
  return study;
}

Polygon Smoothed(const Polygon& even, double sd) {
  double perimeter = 0;
  for (std::size_t k = 0; k < even.size(); ++k) perimeter += (even[(k + 1) % even.size()] - even[k]).norm();
  const double sd_points = sd * static_cast<double>(even.size()) / perimeter;
  if (!(sd_points > 0.3)) return even;  // less does not reach the neighbouring point
  const Polygon once = GaussianMeans(even, sd_points);
  Polygon left(even.size());
  for (std::size_t k = 0; k < even.size(); ++k) left[k] = even[k] - once[k];
  const Polygon back = GaussianMeans(left, sd_points);
  Polygon smooth(even.size());
  for (std::size_t k = 0; k < even.size(); ++k) smooth[k] = once[k] + back[k];
  return smooth;
}

}  // namespace striae::wound
