#include "analysis/wound/detail/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace striae::wound {

SkinCovariance CovarianceOf(const Skin& skin, const Ring& ring, const RingWeights& weights, double block_mm) {
  struct Block {
    Eigen::VectorXd score;
    double residual = 0, weight = 0;
  };
  std::map<std::pair<int, int>, Block> blocks;
  const Eigen::Index n = skin.coefficients.size();
  for (std::size_t k = 0; k < ring.points.size(); ++k) {
    if (weights.weight[k] <= 0) continue;
    const auto& p = ring.points[k];
    Block& block =
        blocks[{static_cast<int>(std::floor(p.x() / block_mm)), static_cast<int>(std::floor(p.y() / block_mm))}];
    if (block.score.size() == 0) block.score = Eigen::VectorXd::Zero(n);
    const double residual = (p.z() - skin.Height(p.x(), p.y())) / skin.radius_mm;
    block.score += weights.weight[k] * residual * skin.Terms(p.x(), p.y());
    block.residual += weights.weight[k] * residual;
    block.weight += weights.weight[k];
  }
  Eigen::MatrixXd middle = Eigen::MatrixXd::Zero(n, n);
  double mean_square = 0;
  for (const auto& [key, block] : blocks) {
    middle += block.score * block.score.transpose();
    mean_square += block.residual * block.residual / block.weight / block.weight;
  }
  const double count = static_cast<double>(blocks.size());
  // Fitting n coefficients removes that much of the blocks' own variance.
  const double factor = count / std::max(count - static_cast<double>(n), count / 6);
  return {factor * skin.inverse_normal * middle * skin.inverse_normal, block_mm,
          std::sqrt(factor * mean_square / std::max(1.0, count)) * skin.radius_mm};
}

double HeightSd(const Skin& skin, const SkinCovariance& covariance, const Eigen::Vector2d& at) {
  const Eigen::VectorXd terms = skin.Terms(at.x(), at.y());
  return std::sqrt(std::max(0.0, terms.dot(covariance.coefficients * terms))) * skin.radius_mm;
}

double VolumeSd(const Skin& skin, const SkinCovariance& covariance, const Bed& bed) {
  Eigen::VectorXd integral = Eigen::VectorXd::Zero(skin.coefficients.size());
  for (const auto& t : bed.triangles) {
    const auto &a = bed.point[t[0]], &b = bed.point[t[1]], &c = bed.point[t[2]];
    const double area = ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x()) / 2;
    const Eigen::Vector3d middle = (a + b + c) / 3;
    integral += area * skin.Terms(middle.x(), middle.y());
  }
  return std::sqrt(std::max(0.0, integral.dot(covariance.coefficients * integral))) * skin.radius_mm;
}

}  // namespace striae::wound
