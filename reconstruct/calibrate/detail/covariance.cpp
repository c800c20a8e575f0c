#include <map>
#include <optional>

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

/// What the residuals of one cell say.
struct Cell {
  Row score;               ///< sum of residual times derivative
  Eigen::MatrixXd normal;  ///< sum of derivative times derivative
};

}  // namespace

Eigen::MatrixXd ClusterCovariance(const ceres::CRSMatrix& jacobian, const std::vector<double>& residuals,
                                  const std::vector<int>& cluster) {
  const int size = jacobian.num_cols;
  Eigen::MatrixXd priors = Eigen::MatrixXd::Zero(size, size);
  std::map<int, Cell> cells;
  for (std::size_t row = 0; row + 1 < jacobian.rows.size(); ++row) {
    const Row j = RowOf(jacobian, row);
    if (row >= cluster.size()) {
      priors.selfadjointView<Eigen::Lower>().rankUpdate(j);
      continue;
    }
    Cell& cell =
        cells.try_emplace(cluster[row], Cell{Row::Zero(size), Eigen::MatrixXd::Zero(size, size)}).first->second;
    cell.score += residuals[row] * j;
    cell.normal.selfadjointView<Eigen::Lower>().rankUpdate(j);
  }
  if (static_cast<int>(cells.size()) <= size) return Eigen::MatrixXd::Zero(size, size);
  priors = Eigen::MatrixXd(priors.selfadjointView<Eigen::Lower>());
  Eigen::MatrixXd normal = priors;
  for (auto& [key, cell] : cells) {
    cell.normal = Eigen::MatrixXd(cell.normal.selfadjointView<Eigen::Lower>());
    normal += cell.normal;
  }
  // Parameters differ by ten orders of magnitude: scaled to a unit diagonal before inverting. What the model does not
  // have keeps a row of zeros.
  Row scale(size);
  for (int i = 0; i < size; ++i) scale[i] = normal(i, i) > 0 ? 1 / std::sqrt(normal(i, i)) : 0;
  const auto inverse_of = [&](const Eigen::MatrixXd& matrix) -> std::optional<Eigen::MatrixXd> {
    Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
    for (int i = 0; i < size; ++i) {
      if (scale[i] == 0) scaled(i, i) = 1;
    }
    const Eigen::FullPivLU<Eigen::MatrixXd> factored(scaled);
    if (!factored.isInvertible()) return std::nullopt;
    return scale.asDiagonal() * factored.inverse() * scale.asDiagonal();
  };
  const auto inverse = inverse_of(normal);
  if (!inverse) return Eigen::MatrixXd::Zero(size, size);
  Eigen::MatrixXd covariance = *inverse * priors * *inverse;
  const double kept = 1 - 1 / static_cast<double>(cells.size());
  for (const auto& [key, cell] : cells) {
    const auto without = inverse_of(normal - cell.normal);
    if (!without) return Eigen::MatrixXd::Zero(size, size);
    const Row moved = *without * cell.score;
    covariance += kept * moved * moved.transpose();
  }
  return (covariance + covariance.transpose()) / 2;
}

}  // namespace striae::reconstruct::detail
