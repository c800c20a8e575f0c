// A photograph in cells, and which of them are sound ground for a stripe order.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "reconstruct/detail/parallel.h"
#include "reconstruct/phase.h"

namespace striae::reconstruct::detail {

constexpr float kValley = 0.87F;     ///< of the amplitude on either side
constexpr float kSureNoises = 4;     ///< and by so many noises below it
constexpr float kSeenNoises = 1;     ///< where noise is larger no bend can be seen, and none is ruled out
constexpr float kBend = 0.09F;       ///< stripes: second difference over a stripe across, two thirds along
constexpr float kSharp = 0.015F;     ///< stripes: second difference over a third of a stripe along
constexpr float kWeakJump = 0.015F;  ///< the same where it goes on from a sharp bend or a larger jump
constexpr float kJump = 0.06F;       ///< stripes: between what lies within 0.8 and 1.7 stripes on either side, across

/// The picture in cells of a sixth of a stripe across and a third along the stripes.
class Grid {
 public:
  explicit Grid(const PhaseResult& phase) {
    const bool horizontal = phase.direction == StripeDirection::kHorizontal;
    const int fine = std::max(1, static_cast<int>(std::lround(phase.carrier_period_px / 6))),
              coarse = std::max(2, static_cast<int>(std::lround(phase.carrier_period_px / 3)));
    cell_x = horizontal ? coarse : fine;
    cell_y = horizontal ? fine : coarse;
    width = phase.mask.width() / cell_x;
    height = phase.mask.height() / cell_y;
    region = Image<std::int32_t>::Unset(width, height);
    amplitude = ImageF::Unset(width, height);
    order = ImageF::Unset(width, height);
    const int averaged = std::min(cell_x, 4);
    ParallelLines(height, [&](int row) {
      const int y = row * cell_y + cell_y / 2;
      const std::int32_t* r = phase.unwrapped.region.Row(y);
      const float *a = phase.amplitude.Row(y), *p = phase.unwrapped.phase.Row(y);
      for (int col = 0; col < width; ++col) {
        const int x = col * cell_x;
        region(col, row) = r[x + cell_x / 2];
        const int first = x + (cell_x - averaged) / 2;
        float sum = 0;
        bool even = true;
        for (int k = 0; k < averaged; ++k) sum += p[first + k], even = even && r[first + k] == region(col, row);
        order(col, row) =
            (even ? sum / static_cast<float>(averaged) : p[x + cell_x / 2]) / (2 * std::numbers::pi_v<float>);
        amplitude(col, row) = std::accumulate(a + x, a + x + averaged, 0.0F) / static_cast<float>(averaged);
      }
    });
    noise = static_cast<float>(phase.noise / std::sqrt(averaged));
    order_noise = static_cast<float>(phase.noise / (2 * std::numbers::pi) / std::sqrt(averaged));
  }
  [[nodiscard]] int Cells(double stripes, double period_px, int cell) const {
    return std::max(1, static_cast<int>(std::lround(stripes * period_px / cell)));
  }

  int cell_x = 1, cell_y = 1, width = 0, height = 0;
  float noise = 0;        ///< of the amplitude
  float order_noise = 0;  ///< times the amplitude, stripes
  Image<std::int32_t> region;
  ImageF amplitude;
  ImageF order;  ///< stripes; NaN outside of the regions
};

/// The largest of the `reach` values before each of the `count` ones (not itself), `stride` apart.
inline void LargestBefore(const float* values, int count, int reach, float* largest) {
  for (int i = 0; i < count; ++i) largest[i] = 0;
  for (int k = 1; k <= reach; ++k) {
    for (int i = k; i < count; ++i) largest[i] = std::max(largest[i], values[i - k]);
  }
}
inline void LargestAfter(const float* values, int count, int reach, float* largest) {
  for (int i = 0; i < count; ++i) largest[i] = 0;
  for (int k = 1; k <= reach; ++k) {
    for (int i = 0; i + k < count; ++i) largest[i] = std::max(largest[i], values[i + k]);
  }
}

/// 1 where the cell is of a region and not in a valley.
inline Mask SoundCells(const Grid& grid, int reach_x, int reach_y) {
  Mask sound(grid.width, grid.height, 0);
  const auto is_valley = [&](float at, float before, float after) {
    const float least = std::min(before, after);
    return at < kValley * least && least - at > kSureNoises * grid.noise;
  };
  ParallelBlocks(grid.height, [&](int, int first, int last) {
    const auto width = static_cast<std::size_t>(grid.width);
    std::vector<float> before(width), after(width);
    for (int row = first; row < last; ++row) {
      const float* a = grid.amplitude.Row(row);
      LargestBefore(a, grid.width, reach_x, before.data());
      LargestAfter(a, grid.width, reach_x, after.data());
      std::uint8_t* to = sound.Row(row);
      for (int x = 0; x < grid.width; ++x) {
        const auto i = static_cast<std::size_t>(x);
        to[x] = grid.region(x, row) >= 0 && !is_valley(a[x], before[i], after[i]) ? 1 : 0;
      }
      std::fill(before.begin(), before.end(), 0.0F);
      std::fill(after.begin(), after.end(), 0.0F);
      for (int k = 1; k <= reach_y; ++k) {
        if (row - k >= 0) {
          const float* up = grid.amplitude.Row(row - k);
          for (std::size_t x = 0; x < width; ++x) before[x] = std::max(before[x], up[x]);
        }
        if (row + k < grid.height) {
          const float* down = grid.amplitude.Row(row + k);
          for (std::size_t x = 0; x < width; ++x) after[x] = std::max(after[x], down[x]);
        }
      }
      for (int x = 0; x < grid.width; ++x) {
        const auto i = static_cast<std::size_t>(x);
        if (is_valley(a[x], before[i], after[i])) to[x] = 0;
      }
    }
  });
  return sound;
}

/// Steps between what lies straight on either side, across the stripes: carried on from 0.8 and 1.7 stripes away to the
/// middle. A bend of even curvature makes none. 0 where it is within the noise or not the largest within half a stripe.
inline ImageF JumpsAcross(const Grid& grid, int dx, int dy) {
  constexpr float kNoises = 3.16F * kSureNoises;  // root of 4 + 1 + 4 + 1
  constexpr int kInside = 4;  // times 0.8 stripes: near the end of a region the window bends the order by itself
  const int dir_x = dx > 0 ? 1 : 0, dir_y = dy > 0 ? 1 : 0, reach = 3;
  ImageF jump(grid.width, grid.height, 0.0F), ridge(grid.width, grid.height, 0.0F);
  ParallelLines(grid.height, [&](int row) {
    if (row < kInside * dy || row + kInside * dy >= grid.height) return;
    const std::int32_t* r = grid.region.Row(row);
    const float* a = grid.amplitude.Row(row);
    const auto regions = [&](int k) { return grid.region.Row(row + k * dy) + k * dx; };
    const auto orders = [&](int k) { return grid.order.Row(row + k * dy) + k * dx; };
    const std::int32_t *r1 = regions(-2), *r2 = regions(-1), *r3 = regions(1), *r4 = regions(2),
                       *first = regions(-kInside), *last = regions(kInside);
    const float *o1 = orders(-2), *o2 = orders(-1), *o3 = orders(1), *o4 = orders(2);
    float* to = jump.Row(row);
    for (int x = kInside * dx; x + kInside * dx < grid.width; ++x) {
      if (first[x] != r[x] || last[x] != r[x]) continue;
      if (r[x] < 0 || r1[x] != r[x] || r2[x] != r[x] || r3[x] != r[x] || r4[x] != r[x]) continue;
      const float step = std::abs(2 * o2[x] - o1[x] - 2 * o3[x] + o4[x]);
      if (step * a[x] > kNoises * grid.order_noise) to[x] = step;
    }
  });
  ParallelLines(grid.height, [&](int row) {
    for (int x = 0; x < grid.width; ++x) {
      const float own = jump(x, row);
      if (own < kWeakJump) continue;
      bool largest = true;
      for (int k = -reach; k <= reach && largest; ++k) {
        const int nx = x + k * dir_x, ny = row + k * dir_y;
        largest = !jump.Contains(nx, ny) || jump(nx, ny) <= own;
      }
      if (largest) ridge(x, row) = own;
    }
  });
  return ridge;
}

/// Takes out the cells where the order is bent: the slope changes along the outline of what lies before. Or where it
/// jumps: over a third of a stripe along the stripes, where the window does not round it, and across them.
inline void TakeOutBends(const Grid& grid, int lag_x, int lag_y, bool horizontal, Mask& sound) {
  constexpr float kSecondDifference = 2.45F;  // root of 1 + 4 + 1

  const int across = std::max(1, (horizontal ? lag_y : lag_x) - 1);
  const ImageF ridge = JumpsAcross(grid, horizontal ? 0 : across, horizontal ? across : 0);
  Mask sharp(grid.width, grid.height, 0);
  ParallelLines(grid.height, [&](int row) {
    std::uint8_t *to = sound.Row(row), *found = sharp.Row(row);
    const float* step = ridge.Row(row);
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
      if (step[x] > kJump) to[x] = 0, found[x] = 1;
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

/// Cells with no unsound one, and no other region's, within the rectangle around them; beyond the picture is sound.
inline Mask Eroded(const Grid& grid, const Mask& sound, int reach_x, int reach_y) {
  Mask narrow(grid.width, grid.height, 0), eroded(grid.width, grid.height, 0);
  ParallelBlocks(grid.height, [&](int, int first, int last) {
    std::vector<int> before(static_cast<std::size_t>(grid.width));  // sound cells of its region that end here
    for (int row = first; row < last; ++row) {
      const std::uint8_t* s = sound.Row(row);
      const std::int32_t* r = grid.region.Row(row);
      int run = reach_x;
      for (int x = 0; x < grid.width; ++x) {
        run = s[x] == 0 ? 0 : (x > 0 && r[x] != r[x - 1] ? 1 : run + 1);
        before[static_cast<std::size_t>(x)] = run;
      }
      run = reach_x;
      for (int x = grid.width - 1; x >= 0; --x) {
        run = s[x] == 0 ? 0 : (x + 1 < grid.width && r[x] != r[x + 1] ? 1 : run + 1);
        narrow(x, row) = run > reach_x && before[static_cast<std::size_t>(x)] > reach_x ? 1 : 0;
      }
    }
  });
  constexpr int kColumns = 64;
  ParallelBlocks(
      grid.width,
      [&](int, int first, int last) {
        // Cells of one region above each other so far, from either end.
        std::vector<int> above(static_cast<std::size_t>(last - first), reach_y), below(above);
        const auto go_on = [&](std::vector<int>& run, int row, int before) {
          const std::uint8_t* s = narrow.Row(row);
          const std::int32_t *r = grid.region.Row(row), *r0 = grid.region.Row(before);
          for (int x = first; x < last; ++x) {
            int& count = run[static_cast<std::size_t>(x - first)];
            count = s[x] == 0 ? 0 : (r[x] != r0[x] ? 1 : count + 1);
          }
        };
        for (int row = 0; row < grid.height; ++row) {
          go_on(above, row, std::max(0, row - 1));
          std::uint8_t* to = eroded.Row(row);
          for (int x = first; x < last; ++x) to[x] = above[static_cast<std::size_t>(x - first)] > reach_y ? 1 : 0;
        }
        for (int row = grid.height - 1; row >= 0; --row) {
          go_on(below, row, std::min(grid.height - 1, row + 1));
          std::uint8_t* to = eroded.Row(row);
          for (int x = first; x < last; ++x)
            if (below[static_cast<std::size_t>(x - first)] <= reach_y) to[x] = 0;
        }
      },
      kColumns);
  return eroded;
}

}  // namespace striae::reconstruct::detail
