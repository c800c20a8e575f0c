#include "reconstruct/detail/uncertainty.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "core/vector.h"
#include "reconstruct/detail/extent.h"
#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {
namespace {

/// Near the end of what is measured the window mixes lit with unlit. Stripes, at a distance of up to so many periods;
/// found on rendered limbs, plates and busts at 1 and 2 m, where the errors at the rims fall so.
struct Border {
  double periods;
  float stripes;
};
constexpr std::array<Border, 4> kBorders = {{{0.25, 0.035F}, {0.5, 0.022F}, {1, 0.011F}, {2, 0.0035F}}};
/// Where the stripes lie closer or wider than the carrier by more than a tenth, a step in depth may be smoothed over:
/// stripes per share of the period beyond it. Found on the same bodies, at chins and ears.
constexpr float kLargestShift = 0.1F, kSteep = 0.3F;
constexpr double kSmoothed =
    0.75;  ///< of the noise is left by the smoothing along the stripes, found on the same bodies
constexpr float kFloor = 0.0004F;  ///< stripes; texture, and what does not follow from the sensor's noise

struct Terms {
  float noise = 0;      ///< over the amplitude: stripes
  float curvature = 0;  ///< times the second difference of the order over the step: stripes
  float shift = 0;      ///< times the first difference over two steps: periods of the carrier a stripe
};

/// Raises border[x] to `stripes` where one of two pixels is missing.
STRIAE_VECTORISED void RaiseWhereMissing(const float* before, const float* after, int first, int last, float stripes,
                                         float* border) {
  for (int x = first; x < last; ++x) {
    const float either = before[x] + after[x];  // NaN when one is
    const float raised = either == either ? 0.0F : stripes;
    border[x] = border[x] > raised ? border[x] : raised;
  }
}

/// Modulation into the background's place, uncertainty into the amplitude's.
STRIAE_VECTORISED void Combine(const float* before, const float* at, const float* after, const float* border,
                               const Extent& extent, const Terms& terms, float* amplitude, float* background) {
  for (int x = extent.first; x < extent.last; ++x) {
    const float modulation = amplitude[x] / std::max(background[x], 1e-6F);
    background[x] = modulation < 1 ? modulation : 1.0F;
    const float of_noise = terms.noise / std::max(amplitude[x], 1e-9F);
    const float bent = terms.curvature * (before[x] + after[x] - 2 * at[x]);
    const float of_shape = bent == bent ? bent : 0.0F;  // NaN beside a border, which has its own term
    const float shifted = std::abs(terms.shift * (after[x] - before[x]) - 1) - kLargestShift;
    const float of_step = shifted > 0 ? kSteep * shifted : 0.0F;  // 0 for NaN
    amplitude[x] = std::sqrt(of_noise * of_noise + kFloor * kFloor + of_shape * of_shape + of_step * of_step +
                             border[x] * border[x]);
  }
}

/// Rows of the image with the pixels that lie a number of pixels away from them in either direction.
class Around {
 public:
  explicit Around(const ImageF& order) : order_(order), border_(static_cast<std::size_t>(order.width())) {}

  const float* BorderOf(int row, const Extent& extent, double period_px) {
    const int width = order_.width(), height = order_.height();
    const float* at = order_.Row(row);
    std::fill(border_.begin() + extent.first, border_.begin() + extent.last, 0.0F);
    for (const Border& term : kBorders) {
      const int step = std::max(1, static_cast<int>(std::lround(term.periods * period_px)));
      // What lies beyond the photograph counts as there: the surface goes on where the picture ends.
      RaiseWhereMissing(order_.Row(std::max(0, row - step)), order_.Row(std::min(height - 1, row + step)), extent.first,
                        extent.last, term.stripes, border_.data());
      RaiseWhereMissing(at - step, at + step, std::max(step, extent.first), std::min(width - step, extent.last),
                        term.stripes, border_.data());
    }
    return border_.data();
  }

 private:
  const ImageF& order_;
  std::vector<float> border_;
};

}  // namespace

void OrderUncertainty(const ImageF& order, StripeDirection direction, double period_px, double window_half_width,
                      double noise, ImageF& amplitude, ImageF& background) {
  const int step = std::max(1, static_cast<int>(std::lround(period_px / 4)));
  // H = (1 + cos(pi (f - f0) / W)) / 2 has the second moment -H''(f0) / (4 pi^2) = 1 / (8 W^2), W = half_width / T.
  const double moment = period_px * period_px / (8 * window_half_width * window_half_width);
  const Terms terms{static_cast<float>(kSmoothed * noise / (2 * std::numbers::pi)),
                    static_cast<float>(moment / 2 / (step * step)), static_cast<float>(period_px / (2 * step))};
  const bool horizontal = direction == StripeDirection::kHorizontal;
  const int width = order.width(), height = order.height();
  ParallelBlocks(height, [&](int, int first, int last) {
    Around around(order);
    std::vector<float> before(static_cast<std::size_t>(width)), after(before);
    for (int row = first; row < last; ++row) {
      const float* at = order.Row(row);
      const Extent extent = ExtentOf(at, width);
      if (extent.empty()) continue;
      const float* border = around.BorderOf(row, extent, period_px);
      const float *b = order.Row(std::max(0, row - step)), *a = order.Row(std::min(height - 1, row + step));
      if (!horizontal) {  // the line is the row itself; its ends repeat
        for (int x = extent.first; x < extent.last; ++x) {
          before[static_cast<std::size_t>(x)] = at[std::max(0, x - step)];
          after[static_cast<std::size_t>(x)] = at[std::min(width - 1, x + step)];
        }
        b = before.data();
        a = after.data();
      }
      Combine(b, at, a, border, extent, terms, amplitude.Row(row), background.Row(row));
    }
  });
}

}  // namespace striae::reconstruct::detail
