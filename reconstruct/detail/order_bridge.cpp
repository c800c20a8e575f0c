#include "reconstruct/detail/order_bridge.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "reconstruct/detail/order_lines.h"

namespace striae::reconstruct::detail {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr int kCell_px = 16;

/// Crossings of one pair's cut.
struct Crossings {
  std::vector<double> jumps;  ///< order of the first region continued minus that of the second, stripes
  int dimmed = 0;             ///< crossings where the stripes do not go on
};

/// Relative orders along a line or a row near a cut, with what is needed to continue them.
class CutReader {
 public:
  CutReader(const PhaseResult& phase, int reach) : phase_(phase), reach_(reach) {}

  /// The cut between the pixels `a` and `b` that face each other `gap` + 1 apart; (dx, dy) leads from a to b.
  void Read(int ax, int ay, int bx, int by, int dx, int dy, Crossings& crossings) const {
    constexpr double kLeastAmplitude = 0.6, kSlopeDifference = 0.3;
    const auto& amplitude = phase_.amplitude;
    const int fx = ax - reach_ * dx, fy = ay - reach_ * dy, gx = bx + reach_ * dx, gy = by + reach_ * dy;
    const auto& region = phase_.unwrapped.region;
    if (!region.Contains(fx, fy) || !region.Contains(gx, gy)) return;
    if (region(fx, fy) != region(ax, ay) || region(gx, gy) != region(bx, by)) return;
    const float least = std::min(amplitude(fx, fy), amplitude(gx, gy));
    float lowest = least;
    for (int x = ax, y = ay; x != bx || y != by; x += dx, y += dy) lowest = std::min(lowest, amplitude(x, y));
    const double at_a = Order(ax, ay), at_b = Order(bx, by);
    const double slope_a = (at_a - Order(fx, fy)) / reach_, slope_b = (Order(gx, gy) - at_b) / reach_;
    const double carrier = 1 / phase_.carrier_period_px;
    if (lowest < kLeastAmplitude * least || std::abs(slope_a - slope_b) > kSlopeDifference * carrier) {
      ++crossings.dimmed;
      return;
    }
    const int distance = std::max(std::abs(bx - ax), std::abs(by - ay));
    crossings.jumps.push_back(at_a + distance * (slope_a + slope_b) / 2 - at_b);
  }

 private:
  [[nodiscard]] double Order(int x, int y) const { return phase_.unwrapped.phase(x, y) / kTwoPi; }
  const PhaseResult& phase_;
  int reach_;
};

/// Walks along rows (dx = 1) or columns (dy = 1) and reads the cuts not wider than `widest`.
void Walk(const PhaseResult& phase, int regions, int dx, int widest, const CutReader& reader,
          std::map<std::pair<int, int>, Crossings>& found) {
  const auto& region = phase.unwrapped.region;
  const int lines = dx == 1 ? region.height() : region.width();
  std::vector<std::pair<int, int>> last(static_cast<std::size_t>(lines), {-1, 0});  // region and position
  const auto visit = [&](int line, int position, int col, int row) {
    const int r = region(col, row);
    if (r < 0) return;
    auto& [before, at] = last[static_cast<std::size_t>(line)];
    if (before >= 0 && before != r && before < regions && r < regions && position - at <= widest + 1) {
      const int ax = dx == 1 ? at : col, ay = dx == 1 ? row : at;
      Crossings cut;
      reader.Read(ax, ay, col, row, dx, 1 - dx, cut);
      Crossings& all = found[std::minmax(before, r)];
      all.dimmed += cut.dimmed;
      for (const double jump : cut.jumps) all.jumps.push_back(before < r ? jump : -jump);
    }
    before = r;
    at = position;
  };
  // In the order of memory, whichever way the lines run.
  for (int row = 0; row < region.height(); ++row) {
    for (int col = 0; col < region.width(); ++col) dx == 1 ? visit(row, col, col, row) : visit(col, row, col, row);
  }
}

}  // namespace

std::vector<Bridge> FindBridges(const PhaseResult& phase, int regions) {
  constexpr std::size_t kFewest = 24;
  constexpr double kMostDimmed = 0.2, kLeastAgreeing = 0.9, kLargestRemainder = 0.12;
  const int period = std::max(2, static_cast<int>(phase.carrier_period_px));
  const int widest = std::max(4, period / 2);
  std::map<std::pair<int, int>, Crossings> found;
  const CutReader reader(phase, period);
  Walk(phase, regions, 1, widest, reader, found);
  Walk(phase, regions, 0, widest, reader, found);
  std::vector<Bridge> bridges;
  for (auto& [pair, crossings] : found) {
    const std::size_t count = crossings.jumps.size();
    if (count < kFewest || crossings.dimmed > kMostDimmed * static_cast<double>(count)) continue;
    const double jump = MedianOf(crossings.jumps);
    const int step = static_cast<int>(std::lround(jump));
    const auto agreeing = static_cast<double>(std::count_if(crossings.jumps.begin(), crossings.jumps.end(),
                                                            [&](double j) { return std::lround(j) == step; })) /
                          static_cast<double>(count);
    if (agreeing < kLeastAgreeing || std::abs(jump - step) > kLargestRemainder) continue;
    bridges.push_back({pair.first, pair.second, step, agreeing * (1 - 2 * std::abs(jump - step))});
  }
  return bridges;
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

double ShareBehindNecks(const PhaseResult& phase, int region) {
  const int cell = std::max(2, static_cast<int>(phase.carrier_period_px / 3));
  constexpr int kErode = 4;  // cells: one and a third of a stripe from either side of a neck
  const int width = phase.mask.width() / cell, height = phase.mask.height() / cell;
  // Distance in cells to the nearest cell that is not all of the region (chessboard metric, two passes).
  Image<std::int32_t> depth(width, height, 0);
  const auto full = [&](int col, int row) {
    for (int y = row * cell; y < (row + 1) * cell; ++y) {
      const std::int32_t* r = phase.unwrapped.region.Row(y);
      for (int x = col * cell; x < (col + 1) * cell; ++x) {
        if (r[x] != region) return false;
      }
    }
    return true;
  };
  const auto near = [&](int col, int row, int step) {
    std::int32_t least = width;
    for (const auto& [x, y] : {std::pair(-step, 0), std::pair(-1, -step), std::pair(0, -step), std::pair(1, -step)}) {
      least = std::min(least, depth.Contains(col + x, row + y) ? depth(col + x, row + y) : width);
    }
    return least;
  };
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) depth(col, row) = full(col, row) ? near(col, row, 1) + 1 : 0;
  }
  for (int row = height - 1; row >= 0; --row) {
    for (int col = width - 1; col >= 0; --col) depth(col, row) = std::min(depth(col, row), near(col, row, -1) + 1);
  }
  // Parts of what is deep inside, by flooding.
  double all = 0, largest = 0;
  std::vector<std::pair<int, int>> open;
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) {
      if (depth(col, row) <= kErode) continue;
      double part = 0;
      open.assign(1, {col, row});
      depth(col, row) = 0;
      while (!open.empty()) {
        const auto [x, y] = open.back();
        open.pop_back();
        ++part;
        for (const auto& [nx, ny] :
             {std::pair(x - 1, y), std::pair(x + 1, y), std::pair(x, y - 1), std::pair(x, y + 1)}) {
          if (!depth.Contains(nx, ny) || depth(nx, ny) <= kErode) continue;
          depth(nx, ny) = 0;
          open.emplace_back(nx, ny);
        }
      }
      all += part;
      largest = std::max(largest, part);
    }
  }
  return all == 0 ? 0 : 1 - largest / all;
}

}  // namespace striae::reconstruct::detail
