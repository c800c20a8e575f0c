#include "analysis/wound/detail/spline.h"

#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace striae::wound {
namespace {

constexpr double kMostKnots = 150, kLeastKnots = 10;

double Phi(double r2) { return r2 > 0 ? 0.5 * r2 * std::log(r2) : 0; }

struct Block {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weight = 0;
};

std::vector<Eigen::Vector3d> BlockMeans(const std::vector<Eigen::Vector3d>& points,
                                        const std::vector<double>& weights) {
  for (double side = 0.1;; side *= 1.25) {
    std::map<std::pair<int, int>, Block> blocks;
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (weights[k] <= 0) continue;
      Block& block = blocks[{static_cast<int>(std::floor(points[k].x() / side)),
                             static_cast<int>(std::floor(points[k].y() / side))}];
      block.sum += weights[k] * points[k];
      block.weight += weights[k];
    }
    if (static_cast<double>(blocks.size()) > kMostKnots) continue;
    double most = 0;
    for (const auto& [key, block] : blocks) most = std::max(most, block.weight);
    std::vector<Eigen::Vector3d> means;
    for (const auto& [key, block] : blocks) {
      if (block.weight > 0.2 * most) means.push_back(block.sum / block.weight);  // slivers at the rim are noisy
    }
    return means;
  }
}

}  // namespace

double Spline::At(double u, double v) const {
  double f = plane[0] + plane[1] * u + plane[2] * v;
  for (std::size_t k = 0; k < knots.size(); ++k) {
    const double du = u - knots[k].x(), dv = v - knots[k].y();
    f += weights[static_cast<Eigen::Index>(k)] * Phi(du * du + dv * dv);
  }
  return f;
}

std::optional<Spline> FitSpline(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights) {
  const auto means = BlockMeans(points, weights);
  if (static_cast<double>(means.size()) < kLeastKnots) return std::nullopt;
  const auto n = static_cast<Eigen::Index>(means.size());
  Eigen::MatrixXd phi(n, n), planes(n, 3);
  Eigen::VectorXd y(n);
  Spline spline;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& p = means[static_cast<std::size_t>(i)];
    spline.knots.emplace_back(p.x(), p.y());
    planes.row(i) << 1, p.x(), p.y();
    y[i] = p.z();
    for (Eigen::Index j = 0; j < n; ++j) {
      phi(i, j) = Phi((p - means[static_cast<std::size_t>(j)]).head<2>().squaredNorm());
    }
  }
  // With planes = Q1 R, the weights are Q2 g, and (Q2^T phi Q2 + lambda) g = Q2^T y: one decomposition for every
  // lambda.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(planes);
  const Eigen::MatrixXd q = qr.householderQ();
  const Eigen::MatrixXd q2 = q.rightCols(n - 3);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(q2.transpose() * phi * q2);
  const Eigen::VectorXd values = eigen.eigenvalues().cwiseMax(0);
  const Eigen::VectorXd rotated = eigen.eigenvectors().transpose() * (q2.transpose() * y);
  double best = std::numeric_limits<double>::infinity(), best_lambda = 0;
  for (double lambda = 1e-6; lambda < 1e5; lambda *= 3) {
    // Residuals are lambda * weights, and the trace of (1 - influence) is the sum of lambda / (value + lambda).
    double rss = 0, trace = 0;
    for (Eigen::Index k = 0; k < values.size(); ++k) {
      const double left = lambda / (values[k] + lambda);
      rss += left * left * rotated[k] * rotated[k];
      trace += left;
    }
    const double gcv = rss / (trace * trace);
    if (gcv >= best) continue;
    best = gcv;
    best_lambda = lambda;
  }
  const Eigen::VectorXd g = rotated.cwiseQuotient((values.array() + best_lambda).matrix());
  spline.weights = q2 * (eigen.eigenvectors() * g);
  spline.plane = planes.colPivHouseholderQr().solve(y - phi * spline.weights - best_lambda * spline.weights);
  return spline;
}

}  // namespace striae::wound
