#include "reconstruct/detail/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/vector.h"
#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {
namespace {

struct Terms {
  float noise = 0;      ///< over the amplitude: stripes
  float floor = 0;      ///< stripes
  float curvature = 0;  ///< times the second difference of the order over the step: stripes
  float border = 0;     ///< stripes, where the line ends within the step
};

STRIAE_VECTORISED void Row(const float* before, const float* at, const float* after, int width, const Terms& terms,
                           float* amplitude, float* background) {
  for (int x = 0; x < width; ++x) {
    const float modulation = amplitude[x] / std::max(background[x], 1e-6F);
    background[x] = modulation < 1 ? modulation : 1.0F;
    const float of_noise = terms.noise / std::max(amplitude[x], 1e-9F);
    const float bent = terms.curvature * (before[x] + after[x] - 2 * at[x]);
    const float of_shape = bent == bent ? std::abs(bent) : terms.border;  // NaN: one of the neighbours is missing
    amplitude[x] = std::sqrt(of_noise * of_noise + terms.floor * terms.floor + of_shape * of_shape);
  }
}

}  // namespace

void OrderUncertainty(const ImageF& order, StripeDirection direction, double period_px, double window_half_width,
                      double noise, ImageF& amplitude, ImageF& background) {
  const int step = std::max(1, static_cast<int>(std::lround(period_px / 4)));
  // H = (1 + cos(pi (f - f0) / W)) / 2 has the second moment -H''(f0) / (4 pi^2) = 1 / (8 W^2), W = half_width / T.
  const double moment = period_px * period_px / (8 * window_half_width * window_half_width);
  Terms terms;
  terms.noise = static_cast<float>(noise / (2 * std::numbers::pi));
  terms.floor = 0.0003F;
  terms.curvature = static_cast<float>(moment / 2 / (step * step));
  terms.border = 0.005F;
  const bool horizontal = direction == StripeDirection::kHorizontal;
  const int width = order.width(), height = order.height();
  ParallelLines(height, [&](int row) {
    const float* at = order.Row(row);
    if (horizontal) {
      const float* before = order.Row(std::max(0, row - step));
      const float* after = order.Row(std::min(height - 1, row + step));
      Row(before, at, after, width, terms, amplitude.Row(row), background.Row(row));
      return;
    }
    const int inner = std::max(0, width - 2 * step);
    Row(at, at, at, std::min(step, width), terms, amplitude.Row(row), background.Row(row));
    Row(at, at + step, at + 2 * step, inner, terms, amplitude.Row(row) + step, background.Row(row) + step);
    if (width > step + inner)
      Row(at, at, at, width - step - inner, terms, amplitude.Row(row) + step + inner,
          background.Row(row) + step + inner);
  });
}

}  // namespace striae::reconstruct::detail
