#include "reconstruct/detail/order_bridge.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reconstruct/detail/order_lines.h"

namespace striae::reconstruct::detail {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr int kCell_px = 16;

}  // namespace

CoarseDepth::CoarseDepth(const OrderScene& scene) : scene_(scene) {}

template <typename Visit>
void CoarseDepth::ForEachCell(int region, const Visit& visit) const {
  for (const auto& [col, row] : cells_[static_cast<std::size_t>(region)]) {
    const int x = col * kCell_px, y = row * kCell_px;
    const Eigen::Vector3d ray = RayOf(scene_.calibration.camera, {static_cast<double>(x), static_cast<double>(y)});
    visit(col, row, ray, scene_.phase.unwrapped.phase(x, y) / kTwoPi);
  }
}

void CoarseDepth::Place() {
  if (cells_.empty()) {
    const auto& region = scene_.phase.unwrapped.region;
    cells_.resize(static_cast<std::size_t>(scene_.phase.unwrapped.regions));
    depth_ = ImageF(region.width() / kCell_px + 1, region.height() / kCell_px + 1, 0.0F);
    for (int row = 0; row * kCell_px < region.height(); ++row) {
      for (int col = 0; col * kCell_px < region.width(); ++col) {
        const int r = region(col * kCell_px, row * kCell_px);
        if (r >= 0) cells_[static_cast<std::size_t>(r)].emplace_back(col, row);
      }
    }
  }
  for (const auto& [region, offset] : noted_) {
    ForEachCell(region, [&, add = offset](int col, int row, const Eigen::Vector3d& ray, double order) {
      if (const auto z = scene_.optics.DepthAt(ray, order + add)) depth_(col, row) = static_cast<float>(*z);
    });
  }
  noted_.clear();
}

double CoarseDepth::MeanAround(int col, int row) const {
  constexpr int kReach = 6;  // about 100 px
  double sum = 0;
  int count = 0;
  for (int y = std::max(0, row - kReach); y <= std::min(depth_.height() - 1, row + kReach); ++y) {
    for (int x = std::max(0, col - kReach); x <= std::min(depth_.width() - 1, col + kReach); ++x) {
      if (depth_(x, y) <= 0) continue;
      sum += depth_(x, y);
      ++count;
    }
  }
  return count == 0 ? 0 : sum / count;
}

std::optional<RegionOrder> CoarseDepth::Continued(int region) {
  Place();
  std::vector<double> offsets;
  ForEachCell(region, [&](int col, int row, const Eigen::Vector3d& ray, double order) {
    const double around = MeanAround(col, row);
    if (around <= 0) return;
    if (const auto expected = scene_.optics.OrderAt(around * ray)) offsets.push_back(*expected - order);
  });
  if (offsets.empty()) return std::nullopt;
  const double expected = MedianOf(offsets);
  RegionOrder found;
  found.source = OrderSource::kBridge;
  found.offset = static_cast<int>(std::lround(expected));
  found.margin = 1 - 2 * std::abs(expected - found.offset);
  found.warning =
      "its whole stripe number continues the depth of the surface beside it; a step of half a stripe or more between "
      "them would go unseen";
  return found;
}

}  // namespace striae::reconstruct::detail
