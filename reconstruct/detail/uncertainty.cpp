#include "reconstruct/detail/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/vector.h"
#include "reconstruct/detail/parallel.h"
#include "reconstruct/misfit.h"

namespace striae::reconstruct::detail {
namespace {

/// Of the noise is left by the smoothing along the stripes; found on rendered limbs, plates and busts at 1 and 2 m.
constexpr double kSmoothed = 0.6;
constexpr float kFloor = 0.0006F;  ///< stripes; texture, and what does not follow from the sensor's noise

/// Modulation into the background's place, uncertainty into the amplitude's.
STRIAE_VECTORISED void Combine(const std::uint8_t* misfit, float usual, int width, float noise, float* amplitude,
                               float* background) {
  for (int x = 0; x < width; ++x) {
    const float modulation = amplitude[x] / std::max(background[x], 1e-6F);
    background[x] = modulation < 1 ? modulation : 1.0F;
    const float of_noise = noise / std::max(amplitude[x], 1e-9F);
    const float own = MisfitOf(misfit[x]);
    constexpr auto kPower = static_cast<float>(kStripesOfMisfit * kStripesOfMisfit);
    const float above = own * own - usual;
    const float of_misfit = kPower * (above > 0 ? above : 0.0F);
    amplitude[x] = std::sqrt(of_noise * of_noise + of_misfit + kFloor * kFloor);
  }
}

}  // namespace

void OrderUncertainty(const Image<std::uint8_t>& misfit, float usual_misfit, double noise, ImageF& amplitude,
                      ImageF& background) {
  const auto of_noise = static_cast<float>(kSmoothed * noise / (2 * std::numbers::pi));
  const float usual = usual_misfit * usual_misfit;
  ParallelLines(amplitude.height(), [&](int row) {
    Combine(misfit.Row(row), usual, amplitude.width(), of_noise, amplitude.Row(row), background.Row(row));
  });
}

}  // namespace striae::reconstruct::detail
