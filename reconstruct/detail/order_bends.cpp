#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "reconstruct/detail/order_sound.h"

namespace striae::reconstruct::detail {
namespace {

constexpr float kSeenNoises = 1;                ///< where noise is larger no bend can be seen, and none is ruled out
constexpr float kBend = 0.09F;                  ///< stripes: second difference over a stripe
                                                ///< across, two thirds along
constexpr float kSharp = 0.015F;                ///< stripes: second difference over a third of a stripe along
constexpr float kJump = 0.06F;                  ///< stripes: between what lies within 0.8
                                                ///< and 1.7 stripes on either side, across
constexpr float kWeakJump = 0.015F;             ///< the same where it goes on from a sharp bend or a larger jump
constexpr std::uint8_t kFaint = 1, kClear = 2;  ///< jumps

/// Steps between what lies straight on either side, across the stripes: carried on from 0.8 and 1.7 stripes away to the
/// middle. A bend of even curvature makes none. 0 where it is within the noise or not the largest within half a stripe.
Mask JumpsAcross(const Grid& grid, int dx, int dy) {
  constexpr float kNoises = 3.16F * kSureNoises;  // root of 4 + 1 + 4 + 1
  constexpr int kInside = 4;                      // times 0.8 stripes: near the end of a region the
                                                  // window bends the order by itself
  constexpr int kReach = 3;
  const int halo = dy > 0 ? kReach : 0;
  Mask found(grid.width, grid.height, 0);
  const auto measure = [&](int row, float* to) {
    std::fill(to, to + grid.width, 0.0F);
    if (row < kInside * dy || row + kInside * dy >= grid.height) return;
    const std::int32_t* r = grid.region.Row(row);
    const float* a = grid.amplitude.Row(row);
    const auto regions = [&](int k) { return grid.region.Row(row + k * dy) + k * dx; };
    const auto orders = [&](int k) { return grid.order.Row(row + k * dy) + k * dx; };
    const std::int32_t *r1 = regions(-2), *r2 = regions(-1), *r3 = regions(1), *r4 = regions(2),
                       *first = regions(-kInside), *last = regions(kInside);
    const float *o1 = orders(-2), *o2 = orders(-1), *o3 = orders(1), *o4 = orders(2);
    for (int x = kInside * dx; x + kInside * dx < grid.width; ++x) {
      const std::int32_t own = r[x];
      const bool inside = (own >= 0) & (first[x] == own) & (r1[x] == own) & (r2[x] == own) & (r3[x] == own) &
                          (r4[x] == own) & (last[x] == own);
      const float step = std::abs(2 * o2[x] - o1[x] - 2 * o3[x] + o4[x]);
      to[x] = inside && step * a[x] > kNoises * grid.order_noise ? step : 0.0F;
    }
  };
  ParallelBlocks(grid.height, [&](int, int first, int last) {
    const int from = std::max(0, first - halo), to = std::min(grid.height, last + halo);
    std::vector<float> jumps(static_cast<std::size_t>(to - from) * static_cast<std::size_t>(grid.width));
    const auto jump = [&](int row) { return jumps.data() + static_cast<std::ptrdiff_t>(row - from) * grid.width; };
    for (int row = from; row < to; ++row) measure(row, jump(row));
    for (int row = first; row < last; ++row) {
      const float* own = jump(row);
      std::uint8_t* mark = found.Row(row);
      for (int x = 0; x < grid.width; ++x) {
        if (own[x] < kWeakJump) continue;
        bool largest = true;
        for (int k = -kReach; k <= kReach && largest; ++k) {
          const int nx = dx > 0 ? x + k : x, ny = dx > 0 ? row : row + k;
          largest = nx < 0 || nx >= grid.width || ny < from || ny >= to || jump(ny)[nx] <= own[x];
        }
        if (largest) mark[x] = own[x] > kJump ? kClear : kFaint;
      }
    }
  });
  return found;
}

}  // namespace

void TakeOutBends(const Grid& grid, int lag_x, int lag_y, bool horizontal, Mask& sound) {
  constexpr float kSecondDifference = 2.45F;  // root of 1 + 4 + 1

  const int across = std::max(1, (horizontal ? lag_y : lag_x) - 1);
  Mask ridge = JumpsAcross(grid, horizontal ? 0 : across, horizontal ? across : 0);
  Mask sharp(grid.width, grid.height, 0);
  ParallelLines(grid.height, [&](int row) {
    std::uint8_t *to = sound.Row(row), *found = sharp.Row(row);
    const std::uint8_t* step = ridge.Row(row);
    const auto judge = [&](const std::int32_t* before, const std::int32_t* at, const std::int32_t* after,
                           const float* ob, const float* o, const float* oa, int from, int end, float most,
                           std::uint8_t* mark) {
      const float* a = grid.amplitude.Row(row);
      for (int x = from; x < end; ++x) {
        if (at[x] < 0 || before[x] != at[x] || after[x] != at[x]) continue;
        const float bend = std::abs(ob[x] - 2 * o[x] + oa[x]);
        if (bend <= most || bend * a[x] <= kSureNoises * kSecondDifference * grid.order_noise) continue;
        to[x] = 0;
        if (mark != nullptr) mark[x] = 1;
      }
    };
    const auto along_x = [&](int lag, float most, std::uint8_t* mark) {
      const std::int32_t* r = grid.region.Row(row);
      const float* o = grid.order.Row(row);
      judge(r - lag, r, r + lag, o - lag, o, o + lag, lag, grid.width - lag, most, mark);
    };
    const auto along_y = [&](int lag, float most, std::uint8_t* mark) {
      if (row < lag || row + lag >= grid.height) return;
      judge(grid.region.Row(row - lag), grid.region.Row(row), grid.region.Row(row + lag), grid.order.Row(row - lag),
            grid.order.Row(row), grid.order.Row(row + lag), 0, grid.width, most, mark);
    };
    const float* a = grid.amplitude.Row(row);
    for (int x = 0; x < grid.width; ++x) {
      if (kBend * a[x] < kSeenNoises * kSecondDifference * grid.order_noise) to[x] = 0;
      if (step[x] == kClear) to[x] = 0, found[x] = 1;
    }
    along_x(lag_x, kBend, nullptr);
    along_y(lag_y, kBend, nullptr);
    horizontal ? along_x(1, kSharp, found) : along_y(1, kSharp, found);
  });
  // Where the outline of a step turns from along to across the stripes it goes on, be it faint there.
  std::vector<std::pair<int, int>> open;
  for (int row = 0; row < grid.height; ++row) {
    for (int x = 0; x < grid.width; ++x) {
      if (sharp(x, row) != 0) open.emplace_back(x, row);
    }
  }
  constexpr int kNear = 2;
  while (!open.empty()) {
    const auto [x, row] = open.back();
    open.pop_back();
    for (int ny = std::max(0, row - kNear); ny <= std::min(grid.height - 1, row + kNear); ++ny) {
      for (int nx = std::max(0, x - kNear); nx <= std::min(grid.width - 1, x + kNear); ++nx) {
        if (ridge(nx, ny) == 0 || sharp(nx, ny) != 0) continue;
        sharp(nx, ny) = 1;
        sound(nx, ny) = 0;
        open.emplace_back(nx, ny);
      }
    }
  }
}

}  // namespace striae::reconstruct::detail
