#include "reconstruct/detail/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/vector.h"
#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {
namespace {

/// Of the noise is left by the smoothing along the stripes; found on rendered limbs, plates and busts at 1 and 2 m.
constexpr double kSmoothed = 0.75;
/// Stripes for a misfit of one: the phase is off by as much as the light, of whose power half turns it and half does
/// not. Rendered bodies give 0.06 to 0.17 for misfits from 0.005 to 0.5, limbs and plates, walls, folds and silhouettes
/// alike.
constexpr float kOfMisfit = 1 / (2 * std::numbers::pi_v<float> * std::numbers::sqrt2_v<float>);
constexpr float kFloor = 0.0004F;  ///< stripes; texture, and what does not follow from the sensor's noise

/// Modulation into the background's place, uncertainty into the amplitude's.
STRIAE_VECTORISED void Combine(const std::uint8_t* misfit, int width, float noise, float* amplitude,
                               float* background) {
  for (int x = 0; x < width; ++x) {
    const float modulation = amplitude[x] / std::max(background[x], 1e-6F);
    background[x] = modulation < 1 ? modulation : 1.0F;
    const float of_noise = noise / std::max(amplitude[x], 1e-9F);
    const float root = static_cast<float>(misfit[x]) * (1 / 255.0F);
    const float of_misfit = kOfMisfit * root * root;
    amplitude[x] = std::sqrt(of_noise * of_noise + of_misfit * of_misfit + kFloor * kFloor);
  }
}

}  // namespace

void OrderUncertainty(const Image<std::uint8_t>& misfit, double noise, ImageF& amplitude, ImageF& background) {
  const auto of_noise = static_cast<float>(kSmoothed * noise / (2 * std::numbers::pi));
  ParallelLines(amplitude.height(), [&](int row) {
    Combine(misfit.Row(row), amplitude.width(), of_noise, amplitude.Row(row), background.Row(row));
  });
}

}  // namespace striae::reconstruct::detail
