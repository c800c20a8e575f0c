#include "analysis/head/detail/uncertainty.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>

#include <Eigen/Dense>

namespace striae::head::detail {
namespace {

constexpr std::size_t kLeastCells = 9;  // fewer say nothing about their own spread

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Normal equations of point-to-plane: rotation first, about the middle of the pairs.
struct Equations {
  Matrix6 matrix = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
};

Eigen::Vector3d Middle(std::span<const Pair> pairs) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double sum = 0;
  for (const Pair& pair : pairs) {
    middle += pair.weight * pair.moved;
    sum += pair.weight;
  }
  return sum > 0 ? Eigen::Vector3d(middle / sum) : middle;
}

void Add(const Pair& pair, const Eigen::Vector3d& middle, Equations& equations) {
  Vector6 row;
  row << (pair.moved - middle).cross(pair.normal), pair.normal;
  equations.matrix += pair.weight * row * row.transpose();
  equations.right -= pair.weight * pair.ToPlane() * row;
}

}  // namespace

double Observability_mm(std::span<const Pair> pairs) {
  if (pairs.size() < 6) return 0;
  const Eigen::Vector3d middle = Middle(pairs);
  Equations all;
  double sum = 0;
  for (const Pair& pair : pairs) {
    Add(pair, middle, all);
    sum += pair.weight;
  }
  const Eigen::Matrix3d turn = all.matrix.topLeftCorner<3, 3>(), mixed = all.matrix.topRightCorner<3, 3>();
  const Eigen::Matrix3d shift = all.matrix.bottomRightCorner<3, 3>();
  // The pseudo-inverse leaves free shifts of a plane free.
  const Eigen::Matrix3d inverse = shift.completeOrthogonalDecomposition().pseudoInverse();
  const Eigen::Matrix3d rest = (turn - mixed * inverse * mixed.transpose()) / std::max(sum, 1e-12);
  const double smallest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(rest).eigenvalues().minCoeff();
  return std::sqrt(std::max(0.0, smallest));
}

std::vector<Eigen::Vector3d> BootstrapRotations(std::span<const Pair> pairs, double cell_mm, int resamples,
                                                std::uint64_t seed) {
  const Eigen::Vector3d middle = Middle(pairs);
  std::map<std::array<int, 3>, Equations> by_cell;
  for (const Pair& pair : pairs) {
    std::array<int, 3> key{};  // by the target: the residual must not choose its own cell
    for (int k = 0; k < 3; ++k)
      key[static_cast<std::size_t>(k)] = static_cast<int>(std::floor(pair.target[k] / cell_mm));
    Add(pair, middle, by_cell[key]);
  }
  if (by_cell.size() < kLeastCells) return {};
  std::vector<const Equations*> cells;
  Equations whole;
  for (const auto& [key, equations] : by_cell) {
    cells.push_back(&equations);
    whole.matrix += equations.matrix;
    whole.right += equations.right;
  }
  const Vector6 best = whole.matrix.ldlt().solve(whole.right);
  std::mt19937_64 random(seed);
  std::vector<Eigen::Vector3d> samples;
  for (int i = 0; i < resamples; ++i) {
    Equations drawn;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const Equations& cell = *cells[random() % cells.size()];
      drawn.matrix += cell.matrix;
      drawn.right += cell.right;
    }
    const Vector6 step = drawn.matrix.ldlt().solve(drawn.right) - best;
    if (!step.allFinite()) return {};
    samples.emplace_back(step.head<3>());
  }
  return samples;
}

}  // namespace striae::head::detail
