#include "analysis/wound/detail/quadric.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace striae::wound {
namespace {

using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

constexpr double kPriorSd = 0.5;    // a cylinder of half the ring's radius has c = 1: anything limb-like is free
constexpr double kLeastRoot = 0.1;  // below this the sheet turns back over itself
constexpr int kMostIterations = 30;

Eigen::Matrix<double, 6, 1> SquareTerms(double u, double v) {
  Eigen::Matrix<double, 6, 1> t;
  t << 1, u, v, u * u, u * v, v * v;
  return t;
}

struct Sheet {
  double w, root;
};

std::optional<Sheet> SheetAt(const Quadric& q, double u, double v) {
  const double linear = 1 + q.bend[0] * u + q.bend[1] * v;
  const double c2 = q.height.dot(SquareTerms(u, v));
  const double discriminant = linear * linear + 4 * q.bend[2] * c2;
  if (linear < kLeastRoot || discriminant < kLeastRoot * kLeastRoot) return std::nullopt;
  const double root = std::sqrt(discriminant);
  return Sheet{2 * c2 / (linear + root), root};
}

Quadric Unpack(const Vector9& p) {
  Quadric q;
  q.bend = p.head<3>();
  q.height = p.tail<6>();
  return q;
}

struct Normal {
  Matrix9 matrix = Matrix9::Zero();
  Vector9 gradient = Vector9::Zero();
  double cost = 0;
};

std::optional<Normal> Linearise(const Vector9& p, const std::vector<Eigen::Vector3d>& points,
                                const std::vector<double>& weights, double prior_weight) {
  const Quadric q = Unpack(p);
  Normal n;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double u = points[k].x(), v = points[k].y();
    const auto sheet = SheetAt(q, u, v);
    if (!sheet) {
      if (weights[k] > 0) return std::nullopt;
      continue;
    }
    const double residual = sheet->w - points[k].z();
    Vector9 slope;
    slope.head<3>() = -Eigen::Vector3d(u * sheet->w, v * sheet->w, sheet->w * sheet->w);
    slope.tail<6>() = SquareTerms(u, v);
    slope /= sheet->root;
    n.matrix.selfadjointView<Eigen::Lower>().rankUpdate(slope, weights[k]);
    n.gradient += weights[k] * residual * slope;
    n.cost += weights[k] * residual * residual;
  }
  n.matrix.diagonal().head<3>().array() += prior_weight;
  n.gradient.head<3>() += prior_weight * p.head<3>();
  n.cost += prior_weight * p.head<3>().squaredNorm();
  return n;
}

}  // namespace

std::optional<double> Quadric::At(double u, double v) const {
  const auto sheet = SheetAt(*this, u, v);
  if (!sheet) return std::nullopt;
  return sheet->w;
}

std::optional<Quadric> FitQuadric(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights,
                                  double noise, double independent) {
  double total = 0;
  for (const double w : weights) total += w;
  const double prior_weight = noise * noise / (kPriorSd * kPriorSd) * std::max(1.0, total / independent);

  Vector9 p = Vector9::Zero();
  auto now = Linearise(p, points, weights, prior_weight);
  if (!now) return std::nullopt;
  double damping = 1e-4;
  for (int iteration = 0; iteration < kMostIterations && damping < 1e8; ++iteration) {
    Matrix9 damped = now->matrix;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().array() += 1e-12 * total;
    const Vector9 step = -damped.selfadjointView<Eigen::Lower>().ldlt().solve(now->gradient);
    auto next = Linearise(p + step, points, weights, prior_weight);
    if (!next || next->cost > now->cost) {
      damping *= 10;
      continue;
    }
    const bool settled = now->cost - next->cost <= 1e-9 * next->cost;
    p += step;
    now = next;
    damping = std::max(1e-9, damping / 10);
    if (settled) break;
  }
  return Unpack(p);
}

}  // namespace striae::wound
