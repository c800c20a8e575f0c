#include "analysis/head/detail/weights.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace striae::head::detail {
namespace {

constexpr double kTukey = 4.0;          // 4.7 has 95 % efficiency on Gaussian noise; the jaw and hair are worth 4 %
constexpr double kLeastScale = 0.5;     // of the stated uncertainties: no better agreement is believed
constexpr double kSharedErrorMm = 0.2;  // of each pair besides: calibration, and the plane that stands for the skin

/// The value that `share` of the numbers stay below.
double Quantile(std::vector<double> values, double share) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace

double WeighRobustly(std::span<Pair> pairs, std::span<const double> sd_mm) {
  if (pairs.empty()) return 0;
  std::vector<double> sd(pairs.size()), size(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    sd[i] = std::hypot(sd_mm[i], kSharedErrorMm);
    size[i] = std::abs(pairs[i].ToPlane()) / sd[i];
  }
  const double reach = kTukey * std::max(kLeastScale, 1.4826 * Quantile(size, 0.5));
  double agreement = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double far = size[i] / reach;
    const double share = far < 1 ? (1 - far * far) * (1 - far * far) : 0;
    pairs[i].weight = share / (sd[i] * sd[i]);
    agreement += share;
  }
  return agreement / static_cast<double>(pairs.size());
}

void WeighTrimmed(std::span<Pair> pairs) {
  if (pairs.empty()) return;
  std::vector<double> size;
  size.reserve(pairs.size());
  for (const Pair& pair : pairs) size.push_back((pair.moved - pair.target).squaredNorm());
  const double most = Quantile(size, 0.9);
  for (Pair& pair : pairs) pair.weight = (pair.moved - pair.target).squaredNorm() <= most ? 1 : 0;
}

Eigen::Isometry3d SolveStep(std::span<const Pair> pairs) {
  Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double sum = 0;
  for (const Pair& pair : pairs) {
    middle += pair.weight * pair.moved;
    sum += pair.weight;
  }
  if (!(sum > 0)) return step;
  middle /= sum;  // about the camera, two metres away, the linearised step would not converge
  Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  for (const Pair& pair : pairs) {
    if (pair.weight <= 0) continue;
    Eigen::Matrix<double, 6, 1> row;
    row << (pair.moved - middle).cross(pair.normal), pair.normal;
    matrix.selfadjointView<Eigen::Lower>().rankUpdate(row, pair.weight);
    right -= pair.weight * pair.ToPlane() * row;
  }
  const Eigen::Matrix<double, 6, 1> found = matrix.selfadjointView<Eigen::Lower>().ldlt().solve(right);
  if (!found.allFinite()) return step;
  const double angle = found.head<3>().norm();
  if (angle > 0) step.linear() = Eigen::AngleAxisd(angle, found.head<3>() / angle).toRotationMatrix();
  step.translation() = found.tail<3>() + middle - step.linear() * middle;
  return step;
}

}  // namespace striae::head::detail
