#include "reconstruct/detail/ray_table.h"

#include <algorithm>
#include <array>

#include "core/optics.h"
#include "core/vector.h"

namespace striae::reconstruct::detail {
namespace {

constexpr double kLargestError_px = 2e-5;

/// Powers of t of the cubic through p(-1), p(0), p(1), p(2), for t from 0 to 1.
template <typename T>
std::array<T, 4> CubicThrough(const T& before, const T& at, const T& next, const T& after) {
  return {at, next - before / 3 - at / 2 - after / 6, (before + next) / 2 - at, (after - before) / 6 + (at - next) / 2};
}

template <typename T>
T ValueAt(const std::array<T, 4>& cubic, double t) {
  return cubic[0] + t * (cubic[1] + t * (cubic[2] + t * cubic[3]));
}

STRIAE_VECTORISED void FillCell(const std::array<double, 4>& cubic, int count, double* out) {
  const double share = 1.0 / count;
  for (int k = 0; k < count; ++k) {
    const double t = k * share;  // exact: steps are powers of two
    out[k] = cubic[0] + t * (cubic[1] + t * (cubic[2] + t * cubic[3]));
  }
}

}  // namespace

RayTable::RayTable(const CameraModel& camera, int width, int height) : width_(width), height_(height) {
  for (;; step_ /= 2) {
    Fill(camera);
    if (step_ == 1 || ErrorAtCorners(camera) < kLargestError_px) return;
  }
}

void RayTable::Fill(const CameraModel& camera) {
  const int columns = (width_ - 1) / step_ + 1, rows = (height_ - 1) / step_ + 1;  // cells
  nodes_ = Image<Eigen::Vector2d>(columns + 3, rows + 3, Eigen::Vector2d::Zero());
  for (int y = 0; y < nodes_.height(); ++y) {
    for (int x = 0; x < nodes_.width(); ++x) {
      nodes_(x, y) =
          RayOf(camera, {static_cast<double>((x - 1) * step_), static_cast<double>((y - 1) * step_)}).head<2>();
    }
  }
}

double RayTable::ErrorAtCorners(const CameraModel& camera) const {
  double largest = 0;
  RowOfRays rays;
  const int half = step_ / 2;
  for (const int row : {std::min(half, height_ - 1), std::max(0, height_ - 1 - half)}) {
    Row(row, 0, width_, rays);
    for (const int col : {std::min(half, width_ - 1), std::max(0, width_ - 1 - half)}) {
      const Eigen::Vector2d found(rays.x[static_cast<std::size_t>(col)], rays.y[static_cast<std::size_t>(col)]);
      const Eigen::Vector2d error =
          found - RayOf(camera, {static_cast<double>(col), static_cast<double>(row)}).head<2>();
      largest = std::max(largest, error.cwiseProduct(Eigen::Vector2d(camera.fx, camera.fy)).norm());
    }
  }
  return largest;
}

void RayTable::Row(int row, int first, int last, RowOfRays& rays) const {
  if (first >= last) return;
  const int cells = nodes_.width() - 3, from = first / step_, to = (last - 1) / step_ + 1;
  rays.x.resize(static_cast<std::size_t>(cells * step_));
  rays.y.resize(rays.x.size());
  const int y = row / step_;
  const double t = static_cast<double>(row % step_) / step_;
  const auto node = [&](int x) -> Eigen::Vector2d {
    return ValueAt(CubicThrough<Eigen::Vector2d>(nodes_(x, y), nodes_(x, y + 1), nodes_(x, y + 2), nodes_(x, y + 3)),
                   t);
  };
  std::array<Eigen::Vector2d, 4> around = {node(from), node(from + 1), node(from + 2), node(from + 3)};
  for (int cell = from; cell < to; ++cell) {
    if (cell > from) around = {around[1], around[2], around[3], node(cell + 3)};
    const auto at = static_cast<std::size_t>(cell * step_);
    FillCell(CubicThrough(around[0].x(), around[1].x(), around[2].x(), around[3].x()), step_, rays.x.data() + at);
    FillCell(CubicThrough(around[0].y(), around[1].y(), around[2].y(), around[3].y()), step_, rays.y.data() + at);
  }
}

}  // namespace striae::reconstruct::detail
