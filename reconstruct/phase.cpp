#include "reconstruct/phase.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "reconstruct/detail/fourier.h"
#include "reconstruct/detail/mask.h"
#include "reconstruct/detail/transpose.h"

namespace striae::reconstruct {
namespace {

using detail::AnalyticSignal;
using detail::Carrier;
using detail::ParallelLines;
using detail::Transposed;

/// Second differences of the phase beyond this (rad) are a step: a smooth surface stays below a tenth of it.
constexpr float kStep_rad = 0.7F;

/// sRGB's decoding (IEC 61966-2-1): the stripes' shading multiplies light, not its encoding.
class Linearisation {
 public:
  Linearisation() {
    for (std::size_t i = 0; i < table_.size(); ++i) {
      const double v = static_cast<double>(i) / kCells;
      table_[i] = static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
    }
  }
  float operator()(float encoded) const {
    const float x = std::clamp(encoded, 0.0F, 1.0F) * kCells;
    const auto cell = std::min(static_cast<std::size_t>(x), static_cast<std::size_t>(kCells - 1));
    return table_[cell] + (x - static_cast<float>(cell)) * (table_[cell + 1] - table_[cell]);
  }

 private:
  static constexpr int kCells = 4096;
  std::array<float, kCells + 1> table_{};
};

const Linearisation& Linear() {
  static const Linearisation linear;
  return linear;
}

ImageF LinearLight(const ImageF& encoded) {
  const Linearisation& linear = Linear();
  ImageF out(encoded.width(), encoded.height());
  ParallelLines(encoded.height(), [&](int row) {
    const float* in = encoded.Row(row);
    float* to = out.Row(row);
    for (int x = 0; x < encoded.width(); ++x) to[x] = linear(in[x]);
  });
  return out;
}

struct Chosen {
  StripeDirection direction;
  Carrier carrier;
  ImageF lines;  ///< across the stripes
};

Result<Chosen> ChooseDirection(const ImageF& encoded, std::optional<StripeDirection> wanted) {
  const bool try_horizontal = wanted.value_or(StripeDirection::kHorizontal) == StripeDirection::kHorizontal;
  const bool try_vertical = wanted.value_or(StripeDirection::kVertical) == StripeDirection::kVertical;
  ImageF transposed = try_horizontal ? detail::TransposedThrough(encoded, Linear()) : ImageF();
  ImageF light = try_vertical ? LinearLight(encoded) : ImageF();
  const auto down = try_horizontal ? detail::FindCarrier(transposed) : std::nullopt;
  const auto along = try_vertical ? detail::FindCarrier(light) : std::nullopt;
  if (!down && !along) {
    return Fail(ErrorCode::kNoCarrier,
                "no stripes are found in this photograph; check that the flash fired through the grating and that the "
                "subject is in focus and within the measuring range");
  }
  if (down && (!along || down->prominence >= along->prominence)) {
    return Chosen{StripeDirection::kHorizontal, *down, std::move(transposed)};
  }
  return Chosen{StripeDirection::kVertical, *along, std::move(light)};
}

/// Upper quartile of the modulation over the pixels whose amplitude is above the noise.
float WellLitModulation(const AnalyticSignal& signal, float least_amplitude) {
  constexpr std::size_t kStep = 37;  // a sample of the pixels will do
  std::vector<float> modulations;
  for (std::size_t i = 0; i < signal.amplitude.size(); i += kStep) {
    const float amplitude = signal.amplitude.pixels()[i];
    if (amplitude > 3 * least_amplitude)
      modulations.push_back(amplitude / std::max(signal.background.pixels()[i], 1e-6F));
  }
  if (modulations.empty()) return 0;
  const auto quartile = modulations.begin() + static_cast<long>(3 * modulations.size() / 4);
  std::nth_element(modulations.begin(), quartile, modulations.end());
  return std::min(1.0F, *quartile);
}

/// Takes out runs of valid pixels shorter than `least` along each line.
void DropShortRuns(Mask& lines, int least) {
  ParallelLines(lines.height(), [&](int line) {
    std::uint8_t* m = lines.Row(line);
    for (int x = 0; x < lines.width();) {
      int end = x;
      while (end < lines.width() && m[end] != 0) ++end;
      if (end - x < least) std::fill(m + x, m + end, std::uint8_t{0});
      x = end + 1;
    }
  });
}

Mask MaskOf(const AnalyticSignal& signal, double period_px, const PhaseOptions& options) {
  const int near = static_cast<int>(std::lround(1.5 * period_px)), far = static_cast<int>(std::lround(3 * period_px));
  const int width = signal.amplitude.width(), height = signal.amplitude.height();
  Mask mask(width, height, 0);
  const auto share = static_cast<float>(options.least_plateau_share);
  const auto share_between = static_cast<float>(options.least_share_between);
  const auto least = static_cast<float>(std::max(signal.noise / options.largest_phase_noise, 1e-5));
  const float modulation =
      std::max(static_cast<float>(options.least_modulation),
               static_cast<float>(options.least_modulation_share) * WellLitModulation(signal, least));
  detail::ParallelBlocks(height, [&](int, int begin, int end) {
    detail::LineMaximum plateau(near, near), before(far, 0), after(0, far);
    std::vector<float> top(static_cast<std::size_t>(width)), left(top), right(top);
    for (int line = begin; line < end; ++line) {
      const float *amplitude = signal.amplitude.Row(line), *background = signal.background.Row(line);
      plateau(amplitude, width, top.data());
      before(amplitude, width, left.data());
      after(amplitude, width, right.data());
      std::uint8_t* m = mask.Row(line);
      for (int x = 0; x < width; ++x) {
        const auto i = static_cast<std::size_t>(x);
        const bool between = std::min(left[i], right[i]) > share * top[i];
        const float needed = (between ? share_between : share) * top[i];
        m[x] = amplitude[x] > least && amplitude[x] > needed && amplitude[x] > modulation * background[x] ? 1 : 0;
      }
    }
  });
  DropShortRuns(mask, static_cast<int>(std::lround(options.least_run_periods * period_px)));
  return mask;
}

/// Turned back to the photograph's orientation; what it was made of is given up at once.
template <typename T>
Image<T> Turned(Image<T>& lines, bool horizontal) {
  Image<T> given = std::move(lines);
  lines = {};
  return horizontal ? Transposed(given) : given;
}

double SaturatedShare(const Photograph& photograph) {
  const auto& pixels = photograph.luminance.pixels();
  const auto saturated =
      std::count_if(pixels.begin(), pixels.end(), [&](float v) { return v >= photograph.saturation_level; });
  return static_cast<double>(saturated) / static_cast<double>(pixels.size());
}

}  // namespace

Result<PhaseResult> MeasurePhase(const Photograph& photograph, const PhaseOptions& options) {
  constexpr int kSmallest_px = 32;
  const int width = photograph.luminance.width(), height = photograph.luminance.height();
  if (width < kSmallest_px || height < kSmallest_px) {
    return Fail(ErrorCode::kBadImage, "the photograph is only " + std::to_string(width) + " x " +
                                          std::to_string(height) + " pixels; at least 32 x 32 are needed");
  }
  auto chosen = ChooseDirection(photograph.luminance, options.direction);
  if (!chosen) return Fail(chosen.error());
  const bool horizontal = chosen->direction == StripeDirection::kHorizontal;

  PhaseResult result;
  result.direction = chosen->direction;
  result.carrier_period_px = chosen->carrier.period_px;
  result.carrier_prominence = chosen->carrier.prominence;
  result.saturated_share = SaturatedShare(photograph);
  AnalyticSignal signal = detail::AnalyseLines(chosen->lines, result.carrier_period_px, options.window_half_width);
  chosen->lines = {};
  result.noise = signal.noise;
  Mask mask = MaskOf(signal, result.carrier_period_px, options);
  result.mask = Turned(mask, horizontal);
  result.amplitude = Turned(signal.amplitude, horizontal);
  result.background = Turned(signal.background, horizontal);
  ImageF wrapped = Turned(signal.phase, horizontal);

  detail::CutSteps(wrapped, result.mask, kStep_rad);
  detail::CleanMask(result.mask, options.least_region_px);
  if (std::none_of(result.mask.pixels().begin(), result.mask.pixels().end(), [](std::uint8_t m) { return m != 0; })) {
    return Fail(ErrorCode::kNoCarrier,
                "the stripes are too faint everywhere to carry phase; check flash, ISO and distance");
  }
  result.unwrapped = Unwrap(wrapped, result.mask);
  wrapped = {};
  result.modulation = ImageF(width, height);
  ParallelLines(height, [&](int row) {
    for (int x = 0; x < width; ++x) {
      const float background = std::max(result.background(x, row), 1e-6F);
      result.modulation(x, row) = std::clamp(result.amplitude(x, row) / background, 0.0F, 1.0F);
    }
  });
  return result;
}

}  // namespace striae::reconstruct
