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

std::vector<int> ShadowedLines(const PhaseResult& phase, int regions) {
  constexpr double kNarrowest = 0.9, kWidest = 8, kFlush = 0.4, kUnlit = 0.4;
  const auto& region = phase.unwrapped.region;
  const bool horizontal = phase.direction == StripeDirection::kHorizontal;
  const double period = phase.carrier_period_px;
  const int reach = std::max(2, static_cast<int>(period));
  const int along = std::max(1, static_cast<int>(period / 3)), across = std::max(1, static_cast<int>(period / 6));
  const int dx = horizontal ? 0 : 1, dy = 1 - dx;
  const auto order = [&](int x, int y) { return phase.unwrapped.phase(x, y) / kTwoPi; };
  const auto modulation = [&](int x, int y) { return phase.amplitude(x, y) / std::max(phase.background(x, y), 1e-6F); };
  const auto is_shadow = [&](int ax, int ay, int bx, int by) {
    const int gap = bx - ax + by - ay, fx = ax - reach * dx, fy = ay - reach * dy, gx = bx + reach * dx,
              gy = by + reach * dy;
    if (gap < kNarrowest * period || gap > kWidest * period || !region.Contains(fx, fy) || !region.Contains(gx, gy))
      return false;
    const int r = region(ax, ay);
    if (region(fx, fy) != r || region(gx, gy) != r) return false;
    const double slope = (order(ax, ay) - order(fx, fy) + order(gx, gy) - order(bx, by)) / (2 * reach);
    const int mx = (ax + bx) / 2, my = (ay + by) / 2;
    return std::abs(order(bx, by) - order(ax, ay) - gap * slope) < kFlush &&
           modulation(mx, my) < kUnlit * std::min(modulation(fx, fy), modulation(gx, gy));
  };
  // In the order of memory, whichever way the lines run.
  const int col_step = horizontal ? along : across, row_step = horizontal ? across : along;
  std::vector<int> last(static_cast<std::size_t>(horizontal ? region.width() : region.height()), -1);
  std::vector<int> lines(static_cast<std::size_t>(regions), 0);
  for (int row = 0; row < region.height(); row += row_step) {
    for (int col = 0; col < region.width(); col += col_step) {
      const int r = region(col, row);
      if (r < 0 || r >= regions) continue;
      int& before = last[static_cast<std::size_t>(horizontal ? col : row)];
      const int at = horizontal ? row : col, ax = horizontal ? col : before, ay = horizontal ? before : row;
      if (before >= 0 && at - before > kNarrowest * period && region(ax, ay) == r && is_shadow(ax, ay, col, row))
        ++lines[static_cast<std::size_t>(r)];
      before = at;
    }
  }
  return lines;
}

CoarseDepth::CoarseDepth(const OrderScene& scene)
    : scene_(scene),
      depth_(scene.phase.mask.width() / kCell_px + 1, scene.phase.mask.height() / kCell_px + 1, 0.0F),
      cells_(static_cast<std::size_t>(scene.phase.unwrapped.regions)) {
  for (int row = 0; row < depth_.height(); ++row) {
    for (int col = 0; col < depth_.width(); ++col) {
      if (!scene.phase.mask.Contains(col * kCell_px, row * kCell_px)) continue;
      const int region = scene.phase.unwrapped.region(col * kCell_px, row * kCell_px);
      if (region >= 0) cells_[static_cast<std::size_t>(region)].emplace_back(col, row);
    }
  }
}

template <typename Visit>
void CoarseDepth::ForEachCell(int region, const Visit& visit) const {
  for (const auto& [col, row] : cells_[static_cast<std::size_t>(region)]) {
    const int x = col * kCell_px, y = row * kCell_px;
    const Eigen::Vector3d ray = RayOf(scene_.calibration.camera, {static_cast<double>(x), static_cast<double>(y)});
    visit(col, row, ray, scene_.phase.unwrapped.phase(x, y) / kTwoPi);
  }
}

void CoarseDepth::Add(int region, int offset) {
  ForEachCell(region, [&](int col, int row, const Eigen::Vector3d& ray, double order) {
    if (const auto z = scene_.optics.DepthAt(ray, order + offset)) depth_(col, row) = static_cast<float>(*z);
  });
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

std::optional<RegionOrder> CoarseDepth::Continued(int region) const {
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
