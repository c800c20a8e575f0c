#include <map>

#include <Eigen/Dense>

#include "reconstruct/calibrate/detail/rig_fit.h"

namespace striae::reconstruct::detail {
namespace {

using Row = Eigen::VectorXd;

Row RowOf(const ceres::CRSMatrix& jacobian, std::size_t row) {
  Row values = Row::Zero(jacobian.num_cols);
  for (int i = jacobian.rows[row]; i < jacobian.rows[row + 1]; ++i) {
    values[jacobian.cols[static_cast<std::size_t>(i)]] = jacobian.values[static_cast<std::size_t>(i)];
  }
  return values;
}

}  // namespace

Eigen::MatrixXd ClusterCovariance(const ceres::CRSMatrix& jacobian, const std::vector<double>& residuals,
                                  const std::vector<int>& cluster) {
  const int size = jacobian.num_cols;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(size, size), meat = normal;
  Eigen::MatrixXd priors = normal;
  std::map<int, Row> scores;
  for (std::size_t row = 0; row + 1 < jacobian.rows.size(); ++row) {
    const Row j = RowOf(jacobian, row);
    normal.selfadjointView<Eigen::Lower>().rankUpdate(j);
    if (row >= cluster.size()) {
      priors.selfadjointView<Eigen::Lower>().rankUpdate(j);
      continue;
    }
    auto& sum = scores.try_emplace(cluster[row], Row::Zero(size)).first->second;
    sum += residuals[row] * j;
  }
  for (const auto& [cell, score] : scores) meat.selfadjointView<Eigen::Lower>().rankUpdate(score);
  const double cells = static_cast<double>(scores.size());
  if (cells <= size) return Eigen::MatrixXd::Zero(size, size);
  meat = (meat * cells / (cells - size) + priors).selfadjointView<Eigen::Lower>();
  normal = Eigen::MatrixXd(normal.selfadjointView<Eigen::Lower>());
  // Parameters differ by ten orders of magnitude: scaled to a unit diagonal before inverting. What the model does not
  // have keeps a row of zeros.
  Row scale(size);
  for (int i = 0; i < size; ++i) scale[i] = normal(i, i) > 0 ? 1 / std::sqrt(normal(i, i)) : 0;
  Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  for (int i = 0; i < size; ++i) {
    if (scale[i] == 0) scaled(i, i) = 1;
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> factored(scaled);
  if (!factored.isInvertible()) return Eigen::MatrixXd::Zero(size, size);
  const Eigen::MatrixXd inverse = scale.asDiagonal() * factored.inverse() * scale.asDiagonal();
  const Eigen::MatrixXd covariance = inverse * meat * inverse;
  return (covariance + covariance.transpose()) / 2;
}

}  // namespace striae::reconstruct::detail
