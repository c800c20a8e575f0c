#include "analysis/wound/detail/deepest.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "analysis/wound/detail/surface_noise.h"

namespace striae::wound {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kHuber = 1.345, kMadToSd = 1.4826;
constexpr std::size_t kLeastPoints = 20;
constexpr double kMostGain = 0.15;  // of the smoothed depth
constexpr double kTogether = 4;     // root of the cells that a stripe's error is common to

struct Sample {
  double x, y, depth;  // columns and rows of cells from the deepest one, mm; along the skin's normal
  double uncertainty;  // of the surface there, mm; 0 where none is known
  double weight = 1;
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
  std::vector<double> weight(samples.size()), size(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) weight[k] = samples[k].weight;
  for (int round = 0; round < 4; ++round) {
    Matrix6 normal = Matrix6::Zero();
    Vector6 right = Vector6::Zero();
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const Vector6 t = Terms(samples[k].x, samples[k].y);
      normal += weight[k] * t * t.transpose();
      right += weight[k] * samples[k].depth * t;
    }
    const auto factor = normal.ldlt();
    fit.coefficients = factor.solve(right);
    fit.inverse = factor.solve(Matrix6::Identity());
    for (std::size_t k = 0; k < samples.size(); ++k) {
      size[k] = std::abs(samples[k].depth - fit.coefficients.dot(Terms(samples[k].x, samples[k].y)));
    }
    std::vector<double> sorted = size;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    fit.sd = std::max(kMadToSd * *middle, 1e-9);
    for (std::size_t k = 0; k < samples.size(); ++k)
      weight[k] = samples[k].weight * std::min(1.0, kHuber * fit.sd / std::max(size[k], 1e-12));
  }
  return fit;
}

// Weights by the surface's own uncertainties, at most 1; their root of the weighted mean square. 0 where not all are
// known.
double WeighByUncertainty(std::vector<Sample>& samples) {
  double least = std::numeric_limits<double>::infinity();
  for (const Sample& s : samples) least = std::min(least, s.uncertainty);
  if (least <= 0) return 0;
  double inverse = 0;
  for (Sample& s : samples) {
    s.weight = least * least / (s.uncertainty * s.uncertainty);
    inverse += 1 / (s.uncertainty * s.uncertainty);
  }
  return std::sqrt(static_cast<double>(samples.size()) / inverse);
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
                    double resolution_mm, double skin_uncertainty_mm) {
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
    samples.push_back({x, y, NormalDepth(skin, bed.point[k]), scene.patch.UncertaintyMm(bed.cell[k])});
  }
  Deepest deepest;
  deepest.at_px =
      scene.patch.Pixel(static_cast<int>(bed.cell[middle] % width), static_cast<int>(bed.cell[middle] / width));
  deepest.depth_mm = smoothed.max_mm;
  if (samples.size() < kLeastPoints) return deepest;
  deepest.surface_mm = BeyondSkin(WeighByUncertainty(samples), skin_uncertainty_mm);
  const Fit fit = FitQuadratic(samples);
  const Eigen::Vector2d top = TopOf(fit, 0.6 * radius_mm);
  const Vector6 terms = Terms(top.x(), top.y());
  const double top_mm = fit.coefficients.dot(terms);
  const double bend = std::max(0.0, -std::min(fit.coefficients[3], fit.coefficients[5]));
  deepest.correction_mm = resolution_mm * resolution_mm / 2 * bend;
  deepest.noise_mm = kTogether * fit.sd * std::sqrt(std::max(0.0, terms.dot(fit.inverse * terms)));
  const double most = kMostGain * smoothed.max_mm;
  deepest.correction_mm = std::min(deepest.correction_mm, most);
  deepest.depth_mm = std::clamp(top_mm + deepest.correction_mm, smoothed.max_mm, smoothed.max_mm + 2 * most);
  return deepest;
}

}  // namespace striae::wound
