// A photograph in cells.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "reconstruct/detail/parallel.h"
#include "reconstruct/phase.h"

namespace striae::reconstruct::detail {

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

}  // namespace striae::reconstruct::detail
