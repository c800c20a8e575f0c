#include "reconstruct/detail/ray_table.h"

#include <algorithm>

#include "core/optics.h"
#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {
namespace {
constexpr double kLargestError_px = 2e-5;
}

RayTable::RayTable(const CameraModel& camera, int width, int height) : width_(width), height_(height) {
  for (;; step_ /= 2) {
    Fill(camera);
    if (step_ == 1 || ErrorAtCorners(camera) < kLargestError_px) return;
  }
}

void RayTable::Fill(const CameraModel& camera) {
  nodes_ = Image<Eigen::Vector2d>((width_ - 1) / step_ + 2, (height_ - 1) / step_ + 2, Eigen::Vector2d::Zero());
  ParallelLines(nodes_.height(), [&](int y) {
    for (int x = 0; x < nodes_.width(); ++x) {
      nodes_(x, y) = RayOf(camera, {static_cast<double>(x * step_), static_cast<double>(y * step_)}).head<2>();
    }
  });
}

double RayTable::ErrorAtCorners(const CameraModel& camera) const {
  double largest = 0;
  for (const int x : {0, nodes_.width() - 2}) {
    for (const int y : {0, nodes_.height() - 2}) {
      const Eigen::Vector2d pixel((x + 0.5) * step_, (y + 0.5) * step_);
      const Eigen::Vector2d error = At(pixel.x(), pixel.y()) - RayOf(camera, pixel).head<2>();
      largest = std::max(largest, error.cwiseProduct(Eigen::Vector2d(camera.fx, camera.fy)).norm());
    }
  }
  return largest;
}

Eigen::Vector2d RayTable::At(double col, double row) const {
  const int x = static_cast<int>(col) / step_, y = static_cast<int>(row) / step_;
  const double u = col / step_ - x, v = row / step_ - y;
  return (1 - v) * ((1 - u) * nodes_(x, y) + u * nodes_(x + 1, y)) +
         v * ((1 - u) * nodes_(x, y + 1) + u * nodes_(x + 1, y + 1));
}

void RayTable::Row(int row, std::vector<Eigen::Vector2d>& rays) const {
  rays.resize(static_cast<std::size_t>(width_));
  const int y = row / step_;
  const double v = static_cast<double>(row % step_) / step_;
  const auto node = [&](int x) -> Eigen::Vector2d { return (1 - v) * nodes_(x, y) + v * nodes_(x, y + 1); };
  Eigen::Vector2d left = node(0);
  for (int x = 0; x * step_ < width_; ++x) {
    const Eigen::Vector2d right = node(x + 1);
    const int last = std::min(width_, (x + 1) * step_);
    for (int col = x * step_; col < last; ++col) {
      rays[static_cast<std::size_t>(col)] = left + (right - left) * (static_cast<double>(col - x * step_) / step_);
    }
    left = right;
  }
}

}  // namespace striae::reconstruct::detail
