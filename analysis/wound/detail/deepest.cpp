#include "analysis/wound/detail/deepest.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace striae::wound {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kHuber = 1.345, kMadToSd = 1.4826;
constexpr std::size_t kLeastPoints = 20;
constexpr double kMostGain = 0.15;  // of the smoothed depth
constexpr double kTogether = 4;     // root of the cells that a stripe's error is common to

struct Sample {
  double x, y, height;  // columns and rows of cells from the deepest one, mm; skin above the bed
};

Vector6 Terms(double x, double y) {
  Vector6 t;
  t << 1, x, y, x * x / 2, x * y, y * y / 2;
  return t;
}

struct Fit {
  Vector6 coefficients = Vector6::Zero();
  Matrix6 inverse = Matrix6::Zero();
  double sd = 0;
};

Fit FitQuadratic(const std::vector<Sample>& samples) {
  Fit fit;
  std::vector<double> weight(samples.size(), 1), size(samples.size());
  for (int round = 0; round < 4; ++round) {
    Matrix6 normal = Matrix6::Zero();
    Vector6 right = Vector6::Zero();
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const Vector6 t = Terms(samples[k].x, samples[k].y);
      normal += weight[k] * t * t.transpose();
      right += weight[k] * samples[k].height * t;
    }
    const auto factor = normal.ldlt();
    fit.coefficients = factor.solve(right);
    fit.inverse = factor.solve(Matrix6::Identity());
    for (std::size_t k = 0; k < samples.size(); ++k) {
      size[k] = std::abs(samples[k].height - fit.coefficients.dot(Terms(samples[k].x, samples[k].y)));
    }
    std::vector<double> sorted = size;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    fit.sd = std::max(kMadToSd * *middle, 1e-9);
    for (std::size_t k = 0; k < samples.size(); ++k)
      weight[k] = std::min(1.0, kHuber * fit.sd / std::max(size[k], 1e-12));
  }
  return fit;
}

// Where within the circle the quadratic is highest: on a grid, as a ridge's top may lie on its rim.
Eigen::Vector2d TopOf(const Fit& fit, double radius_mm) {
  constexpr int kSteps = 20;
  Eigen::Vector2d best(0, 0);
  double highest = fit.coefficients[0];
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (int j = -kSteps; j <= kSteps; ++j) {
      const Eigen::Vector2d at = Eigen::Vector2d(i, j) * radius_mm / kSteps;
      if (at.norm() > radius_mm) continue;
      const double height = fit.coefficients.dot(Terms(at.x(), at.y()));
      if (height <= highest) continue;
      highest = height;
      best = at;
    }
  }
  return best;
}

}  // namespace

Deepest FindDeepest(const Scene& scene, const Bed& bed, const Skin& skin, const Depths& smoothed, double radius_mm,
                    double resolution_mm) {
  const auto width = static_cast<std::size_t>(scene.patch.width);
  const double cell = scene.patch.cell_mm();
  std::size_t middle = 0;
  for (std::size_t k = 0; k < bed.cell.size(); ++k) {
    if ((bed.point[k].head<2>() - smoothed.deepest).norm() < (bed.point[middle].head<2>() - smoothed.deepest).norm()) {
      middle = k;
    }
  }
  std::vector<Sample> samples;
  const auto col = [&](std::size_t k) { return static_cast<double>(bed.cell[k] % width) * cell; };
  const auto row = [&](std::size_t k) { return static_cast<double>(bed.cell[k] / width) * cell; };
  for (std::size_t k = 0; k < bed.cell.size(); ++k) {
    const double x = col(k) - col(middle), y = row(k) - row(middle);
    if (scene.patch.state[bed.cell[k]] != Patch::kMeasured || bed.distance[k] > 0 || std::hypot(x, y) > radius_mm)
      continue;
    const auto& p = bed.point[k];
    samples.push_back({x, y, skin.Height(p.x(), p.y()) - p.z()});
  }
  Deepest deepest{smoothed.max_mm, 0, 0};
  if (samples.size() < kLeastPoints) return deepest;
  const Fit fit = FitQuadratic(samples);
  const Eigen::Vector2d top = TopOf(fit, 0.6 * radius_mm);
  const Vector6 terms = Terms(top.x(), top.y());
  const double along_axis = fit.coefficients.dot(terms);
  const double bend = std::max(0.0, -std::min(fit.coefficients[3], fit.coefficients[5]));
  deepest.correction_mm = resolution_mm * resolution_mm / 2 * bend;
  const Eigen::Vector2d g = skin.Gradient(smoothed.deepest.x(), smoothed.deepest.y());
  const double to_normal = 1 / std::sqrt(1 + g.squaredNorm());
  deepest.correction_mm *= to_normal;
  deepest.noise_mm = kTogether * fit.sd * std::sqrt(std::max(0.0, terms.dot(fit.inverse * terms)));
  const double most = kMostGain * smoothed.max_mm;
  deepest.correction_mm = std::min(deepest.correction_mm, most);
  deepest.depth_mm =
      std::clamp(along_axis * to_normal + deepest.correction_mm, smoothed.max_mm, smoothed.max_mm + 2 * most);
  return deepest;
}

}  // namespace striae::wound
