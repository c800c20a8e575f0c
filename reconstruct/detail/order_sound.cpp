#include "reconstruct/detail/order_sound.h"

#include <algorithm>
#include <vector>

namespace striae::reconstruct::detail {
namespace {

constexpr float kValley = 0.87F;  ///< of the amplitude on either side

/// The largest of the `reach` values before each of the `count` ones (not itself), `stride` apart.
void LargestBefore(const float* values, int count, int reach, float* largest) {
  for (int i = 0; i < count; ++i) largest[i] = 0;
  for (int k = 1; k <= reach; ++k) {
    for (int i = k; i < count; ++i) largest[i] = std::max(largest[i], values[i - k]);
  }
}
void LargestAfter(const float* values, int count, int reach, float* largest) {
  for (int i = 0; i < count; ++i) largest[i] = 0;
  for (int k = 1; k <= reach; ++k) {
    for (int i = 0; i + k < count; ++i) largest[i] = std::max(largest[i], values[i + k]);
  }
}

}  // namespace

Mask SoundCells(const Grid& grid, int reach_x, int reach_y) {
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

Mask Eroded(const Grid& grid, const Mask& sound, int reach_x, int reach_y) {
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
