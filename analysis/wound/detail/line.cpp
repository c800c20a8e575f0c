#include "analysis/wound/detail/line.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/outline.h"

namespace striae::wound {
namespace {

constexpr double kMadToSd = 1.4826;
constexpr double kCorner = 0.5;        // cosine of the turn beyond which a point is a corner that was meant
constexpr double kCurveCorner = 0.26;  // the same for the curve: the jitter of few points turns it by 30 degrees

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

Polygon WithoutRepeats(const Polygon& drawn) {
  Polygon distinct;
  for (const auto& p : drawn) {
    if (distinct.empty() || (p - distinct.back()).norm() > 1e-9 * (1 + p.norm())) distinct.push_back(p);
  }
  while (distinct.size() > 1 && (distinct.front() - distinct.back()).norm() <= 1e-9) distinct.pop_back();
  return distinct;
}

bool IsCorner(const Eigen::Vector2d& before, const Eigen::Vector2d& at, const Eigen::Vector2d& after) {
  const Eigen::Vector2d in = at - before, out = after - at;
  return in.dot(out) < kCurveCorner * in.norm() * out.norm();
}

}  // namespace

Polygon ClosedCurve(const Polygon& drawn) {
  constexpr std::size_t kLeastPoints = 8, kMostPoints = 400;  // the chords of more lose less than 0.01 %
  const Polygon p = WithoutRepeats(drawn);
  const std::size_t n = p.size();
  if (n < kLeastPoints || n > kMostPoints) return drawn;
  const auto pieces = static_cast<int>(std::clamp<std::size_t>(800 / n, 2, 12));
  // Per unit of the parameter, whose step is the root of the chord; at a corner each side keeps its own direction.
  const auto step = [&](std::size_t k) { return std::sqrt((p[(k + 1) % n] - p[k % n]).norm()); };
  const auto tangent = [&](std::size_t k, std::size_t side) -> Eigen::Vector2d {
    const auto &a = p[(k + n - 1) % n], &b = p[k % n], &c = p[(k + 1) % n];
    if (IsCorner(a, b, c)) return (p[(side + 1) % n] - p[side % n]) / step(side);
    const double before = step(k + n - 1), after = step(k);
    return (b - a) / before - (c - a) / (before + after) + (c - b) / after;
  };
  Polygon curve;
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector2d &from = p[k], &to = p[(k + 1) % n];
    const Eigen::Vector2d m0 = tangent(k, k) * step(k), m1 = tangent(k + 1, k) * step(k);
    for (int j = 0; j < pieces; ++j) {
      const double t = static_cast<double>(j) / pieces, t2 = t * t, t3 = t2 * t;
      curve.emplace_back((2 * t3 - 3 * t2 + 1) * from + (t3 - 2 * t2 + t) * m0 + (3 * t2 - 2 * t3) * to +
                         (t3 - t2) * m1);
    }
  }
  return SelfCrossing(curve) ? drawn : curve;
}

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
