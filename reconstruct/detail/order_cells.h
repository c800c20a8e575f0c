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

constexpr float kValley = 0.87F;  ///< of the amplitude on either side
constexpr float kSureNoises = 4;  ///< and by so many noises below it
constexpr float kSeenNoises = 1;  ///< where noise is larger no bend can be seen, and none is ruled out
constexpr float kBend = 0.09F;    ///< stripes: second difference over a stripe across, two thirds along

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
        order(col, row) = p[x + cell_x / 2] / (2 * std::numbers::pi_v<float>);
        amplitude(col, row) = std::accumulate(a + x, a + x + averaged, 0.0F) / static_cast<float>(averaged);
      }
    });
    noise = static_cast<float>(phase.noise / std::sqrt(averaged));
    order_noise = static_cast<float>(phase.noise / (2 * std::numbers::pi));
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

/// Takes out the cells where the order is bent: the slope changes along the outline of what lies before.
inline void TakeOutBends(const Grid& grid, int lag_x, int lag_y, Mask& sound) {
  constexpr float kSecondDifference = 2.45F;  // root of 1 + 4 + 1
  ParallelLines(grid.height, [&](int row) {
    std::uint8_t* to = sound.Row(row);
    const std::int32_t* r = grid.region.Row(row);
    const float *at = grid.order.Row(row), *a = grid.amplitude.Row(row);
    const auto judge = [&](int x, float bend) {
      if (bend > kBend && bend * a[x] > kSureNoises * kSecondDifference * grid.order_noise) to[x] = 0;
    };
    for (int x = 0; x < grid.width; ++x) {
      if (kBend * a[x] < kSeenNoises * kSecondDifference * grid.order_noise) to[x] = 0;
    }
    for (int x = lag_x; x + lag_x < grid.width; ++x) {
      if (r[x] >= 0 && r[x - lag_x] == r[x] && r[x + lag_x] == r[x])
        judge(x, std::abs(at[x - lag_x] - 2 * at[x] + at[x + lag_x]));
    }
    if (row < lag_y || row + lag_y >= grid.height) return;
    const std::int32_t *ru = grid.region.Row(row - lag_y), *rd = grid.region.Row(row + lag_y);
    const float *up = grid.order.Row(row - lag_y), *down = grid.order.Row(row + lag_y);
    for (int x = 0; x < grid.width; ++x) {
      if (r[x] >= 0 && ru[x] == r[x] && rd[x] == r[x]) judge(x, std::abs(up[x] - 2 * at[x] + down[x]));
    }
  });
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
