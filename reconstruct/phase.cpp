#include "reconstruct/phase.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "reconstruct/detail/carrier.h"
#include "reconstruct/detail/fourier.h"
#include "reconstruct/detail/lane_mask.h"
#include "reconstruct/detail/mask.h"
#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct {
namespace {

using detail::Carrier;
using detail::kLanes;
using detail::Lanes;
using detail::LineAnalysis;
using detail::LineLayout;

/// Second differences of the phase beyond this (rad) are a step: a smooth surface stays below a tenth of it.
constexpr float kStep_rad = 0.7F;

/// Light to be read, and whether its memory may be written over.
struct Source {
  const ImageF& luminance;
  bool linear;
  float saturation_level;
  ImageF* spare;  ///< the luminance itself, or nothing
};

struct Chosen {
  StripeDirection direction;
  LineLayout layout;  ///< of the lines across the stripes
  Carrier carrier;
};

Result<Chosen> ChooseDirection(const Source& source, std::optional<StripeDirection> wanted) {
  std::optional<Chosen> best;
  for (const auto direction : {StripeDirection::kHorizontal, StripeDirection::kVertical}) {
    if (wanted.value_or(direction) != direction) continue;
    const LineLayout layout(source.luminance.width(), source.luminance.height(),
                            direction == StripeDirection::kHorizontal);
    const auto carrier = detail::FindCarrier(detail::SampleLines(source.luminance, layout, source.linear));
    if (!carrier || (best && best->carrier.prominence >= carrier->prominence)) continue;
    best = Chosen{direction, layout, *carrier};
  }
  if (best) return std::move(*best);
  return Fail(ErrorCode::kNoCarrier,
              "no stripes are found in this photograph; check that the flash fired through the grating and that the "
              "subject is in focus and within the measuring range");
}

/// One thread's memory for a block of lines.
struct BlockMemory {
  BlockMemory(const LineAnalysis& analysis, int length)
      : scratch(analysis),
        light(Count(length)),
        phase(Count(length)),
        amplitude(Count(length)),
        background(Count(length)),
        stripes(Count(length)),
        mask(Count(length)),
        misfit(Count(length)) {}
  static std::size_t Count(int length) { return static_cast<std::size_t>(length) * kLanes; }
  LineAnalysis::Signal Signal() { return {phase.data(), amplitude.data(), background.data(), stripes.data()}; }

  LineAnalysis::Scratch scratch;
  Lanes<float> with_halo;
  Lanes<float> light, phase, amplitude, background, stripes, groups, maximum, falling;
  Lanes<std::uint8_t> mask, misfit;
  Lanes<std::uint16_t> runs;
};

/// Reads blocks of lines as linear light, smoothed along the stripes.
class LightReader {
 public:
  LightReader(const Source& source, const LineLayout& layout, double sigma_px)
      : source_(source), layout_(layout), kernel_(detail::GaussianKernel(sigma_px)) {}

  /// Nothing is read but the block's own lines: they may be written over as soon as they are read.
  [[nodiscard]] bool WithoutHalo() const { return kernel_.size() == 1; }

  [[nodiscard]] bool linear() const { return source_.linear; }

  /// Returns the number of saturated pixels.
  std::size_t Read(int block, BlockMemory& m) const {
    const int halo = static_cast<int>(kernel_.size()) - 1;
    if (halo == 0) {  // nothing to smooth: read in place
      layout_.LoadWithHalo(source_.luminance, block, 0, m.light.data());
      const std::size_t saturated =
          detail::CountAtLeast(m.light.data(), layout_.length(), 0, layout_.LanesOf(block), source_.saturation_level);
      if (!source_.linear) detail::DecodeSrgb(m.light.data(), m.light.size());
      return saturated;
    }
    m.with_halo.resize(static_cast<std::size_t>(layout_.length()) * static_cast<std::size_t>(kLanes + 2 * halo));
    layout_.LoadWithHalo(source_.luminance, block, halo, m.with_halo.data());
    const std::size_t saturated = detail::CountAtLeast(m.with_halo.data(), layout_.length(), halo,
                                                       layout_.LanesOf(block), source_.saturation_level);
    if (!source_.linear) detail::DecodeSrgb(m.with_halo.data(), m.with_halo.size());
    detail::SmoothAcross(m.with_halo.data(), layout_.length(), kernel_, m.light.data());
    return saturated;
  }

 private:
  const Source& source_;
  const LineLayout& layout_;
  std::vector<float> kernel_;
};

/// A few evenly spread blocks: enough for the noise and the usual modulation.
std::vector<Lanes<float>> SampleBlocks(const LightReader& reader, const LineLayout& layout, BlockMemory& memory) {
  constexpr int kMost = 12;
  const int count = std::min(kMost, layout.blocks());
  std::vector<Lanes<float>> blocks;
  for (int k = 0; k < count; ++k) {
    reader.Read(static_cast<int>((k + 0.5) * layout.blocks() / count), memory);
    blocks.push_back(memory.light);
  }
  return blocks;
}

/// Of the sampled pixels whose amplitude is above the noise.
struct Typical {
  float modulation = 0;           ///< upper quartile
  std::uint8_t least_misfit = 0;  ///< lower quartile, as LaneMisfit keeps it
  std::uint8_t misfit = 0;        ///< median
};

Typical TypicalOf(const LineAnalysis& analysis, const std::vector<Lanes<float>>& blocks, float least_amplitude,
                  BlockMemory& memory) {
  constexpr std::size_t kStep = 3;  // of the sampled pixels
  std::vector<float> modulations;
  std::vector<std::uint8_t> misfits;
  for (const Lanes<float>& light : blocks) {
    analysis.Background(light.data(), memory.background.data(), memory.scratch);
    analysis.Stripes(light.data(), memory.Signal(), memory.scratch);
    analysis.Misfit(light.data(), memory.Signal(), memory.misfit.data(), memory.scratch);
    for (std::size_t i = 0; i < light.size(); i += kStep) {
      if (memory.amplitude[i] <= 3 * least_amplitude) continue;
      modulations.push_back(memory.amplitude[i] / std::max(memory.background[i], 1e-6F));
      misfits.push_back(memory.misfit[i]);
    }
  }
  if (modulations.empty()) return {};
  const auto quartile = modulations.begin() + static_cast<long>(3 * modulations.size() / 4);
  std::nth_element(modulations.begin(), quartile, modulations.end());
  const auto middle = misfits.begin() + static_cast<long>(misfits.size() / 2);
  std::nth_element(misfits.begin(), middle, misfits.end());
  const auto least = misfits.begin() + static_cast<long>(misfits.size() / 4);
  std::nth_element(misfits.begin(), least, middle);
  return {*quartile, *least, *middle};
}

/// Fills the result's `noise`, `most_misfit` and `usual_misfit` as well.
detail::MaskLimits LimitsOf(const LineAnalysis& analysis, const LightReader& reader, const LineLayout& layout,
                            const PhaseOptions& options, PhaseResult& result) {
  BlockMemory memory(analysis, layout.length());
  const std::vector<Lanes<float>> blocks = SampleBlocks(reader, layout, memory);
  result.noise = analysis.Noise(blocks);
  detail::MaskLimits limits;
  // Eight bits of sRGB resolve no less near black; noise alone may be smaller there.
  constexpr double kStepNearBlack = 1 / (255 * 12.92);
  limits.least_amplitude =
      static_cast<float>(std::max(result.noise / options.largest_phase_noise, reader.linear() ? 1e-5 : kStepNearBlack));
  const Typical typical = TypicalOf(analysis, blocks, limits.least_amplitude, memory);
  limits.least_modulation =
      std::max(static_cast<float>(options.least_modulation),
               static_cast<float>(options.least_modulation_share) * std::min(1.0F, typical.modulation));
  limits.most_modulation = std::max(static_cast<float>(options.most_modulation),
                                    static_cast<float>(options.most_modulation_share) * typical.modulation);
  limits.least_share = static_cast<float>(options.least_plateau_share);
  result.usual_misfit = MisfitOf(typical.least_misfit);
  const double usual = static_cast<double>(MisfitOf(typical.misfit));
  result.most_misfit = KeptMisfit(std::max(options.most_misfit, options.most_misfit_times * usual));
  limits.rim_px = static_cast<int>(std::lround(options.rim_periods * result.carrier_period_px));
  limits.least_run_px = static_cast<int>(std::lround(options.least_run_periods * result.carrier_period_px));
  return limits;
}

/// The plateau is looked for among the largest of a few neighbours: the amplitude does not change faster.
struct Plateau {
  explicit Plateau(double period_px)
      : group(period_px >= 12 ? 4 : 1), reach(static_cast<int>(std::lround(1.5 * period_px / group))) {}
  int group, reach;  ///< pixels; groups on either side
};

void AnalyseBlock(const LineAnalysis& analysis, const detail::MaskLimits& limits, const Plateau& plateau, int length,
                  BlockMemory& m) {
  analysis.Background(m.light.data(), m.background.data(), m.scratch);
  if (analysis.Unlit(m.light.data(), limits.least_amplitude, limits.least_modulation)) {
    std::fill(m.phase.begin(), m.phase.end(), 0.0F);
    std::fill(m.amplitude.begin(), m.amplitude.end(), 0.0F);
    std::fill(m.mask.begin(), m.mask.end(), std::uint8_t{0});
    std::fill(m.misfit.begin(), m.misfit.end(), std::uint8_t{255});
    return;
  }
  analysis.Stripes(m.light.data(), m.Signal(), m.scratch);
  analysis.Misfit(m.light.data(), m.Signal(), m.misfit.data(), m.scratch);
  const int groups = (length + plateau.group - 1) / plateau.group;
  m.groups.resize(BlockMemory::Count(groups));
  m.maximum.resize(BlockMemory::Count(groups));
  detail::GroupMaximum(m.amplitude.data(), length, plateau.group, m.groups.data());
  detail::LaneMaximum(m.groups.data(), groups, plateau.reach, m.maximum.data(), m.falling);
  detail::JudgeLanes(m.amplitude.data(), m.background.data(), m.maximum.data(), length, plateau.group, limits,
                     m.mask.data());
  detail::DropShortRuns(m.mask.data(), length, limits.least_run_px, m.runs);
  detail::TrimRuns(m.mask.data(), length, limits.rim_px, m.runs);
}

/// Fills the images of `result` and the wrapped phase, block by block; each block stays in the processor's cache.
void AnalyseBlocks(const LightReader& reader, const LineLayout& layout, const LineAnalysis& analysis,
                   const detail::MaskLimits& limits, ImageF& wrapped, PhaseResult& result) {
  const Plateau plateau(result.carrier_period_px);
  const auto threads = static_cast<std::size_t>(detail::ThreadCount());
  std::vector<std::unique_ptr<BlockMemory>> memories(threads);
  std::vector<std::size_t> saturated(threads, 0);
  detail::ParallelBlocks(
      layout.blocks(),
      [&](int thread, int first, int last) {
        const auto t = static_cast<std::size_t>(thread);
        if (!memories[t]) memories[t] = std::make_unique<BlockMemory>(analysis, layout.length());
        BlockMemory& m = *memories[t];
        for (int block = first; block < last; ++block) {
          saturated[t] += reader.Read(block, m);
          AnalyseBlock(analysis, limits, plateau, layout.length(), m);
          layout.Store(m.phase.data(), block, wrapped);
          layout.Store(m.amplitude.data(), block, result.amplitude);
          layout.Store(m.background.data(), block, result.background);
          layout.Store(m.mask.data(), block, result.mask);
          layout.Store(m.misfit.data(), block, result.misfit);
        }
      },
      1);
  result.saturated_share = static_cast<double>(std::accumulate(saturated.begin(), saturated.end(), std::size_t{0})) /
                           static_cast<double>(wrapped.size());
}

Result<PhaseResult> Measure(const Source& source, const PhaseOptions& options) {
  constexpr int kSmallest_px = 32;
  const int width = source.luminance.width(), height = source.luminance.height();
  if (width < kSmallest_px || height < kSmallest_px) {
    return Fail(ErrorCode::kBadImage, "the photograph is only " + std::to_string(width) + " x " +
                                          std::to_string(height) + " pixels; at least 32 x 32 are needed");
  }
  const auto chosen = ChooseDirection(source, options.direction);
  if (!chosen) return Fail(chosen.error());

  PhaseResult result;
  result.direction = chosen->direction;
  result.carrier_period_px = chosen->carrier.period_px;
  result.carrier_prominence = chosen->carrier.prominence;
  const LineAnalysis analysis(chosen->layout.length(), result.carrier_period_px, options.window,
                              options.remove_background);
  const LightReader reader(source, chosen->layout, options.smoothing_along * result.carrier_period_px);
  const auto limits = LimitsOf(analysis, reader, chosen->layout, options, result);

  const bool in_place = source.spare != nullptr && reader.WithoutHalo();
  ImageF own = in_place ? ImageF() : ImageF::Unset(width, height);
  ImageF& wrapped = in_place ? *source.spare : own;
  for (ImageF* image : {&result.amplitude, &result.background}) *image = ImageF::Unset(width, height);
  for (Mask* image : {&result.mask, &result.misfit}) *image = Mask::Unset(width, height);
  for (ImageF* image : {&wrapped, &result.amplitude, &result.background}) detail::TouchPages(*image);
  for (Mask* image : {&result.mask, &result.misfit}) detail::TouchPages(*image);
  AnalyseBlocks(reader, chosen->layout, analysis, limits, wrapped, result);

  detail::CutSteps(wrapped, result.mask, kStep_rad);
  detail::CleanMask(result.mask, options.least_region_px);
  if (std::none_of(result.mask.pixels().begin(), result.mask.pixels().end(), [](std::uint8_t m) { return m != 0; })) {
    return Fail(ErrorCode::kNoCarrier,
                "the stripes are too faint everywhere to carry phase; check flash, ISO and distance");
  }
  result.unwrapped = Unwrap(std::move(wrapped), result.mask, &result.misfit);
  return result;
}

}  // namespace

Result<PhaseResult> MeasurePhase(const Photograph& photograph, const PhaseOptions& options) {
  return Measure({photograph.luminance, photograph.linear, photograph.saturation_level, nullptr}, options);
}

Result<PhaseResult> MeasurePhase(Photograph&& photograph, const PhaseOptions& options) {
  ImageF luminance = std::move(photograph.luminance);
  return Measure({luminance, photograph.linear, photograph.saturation_level, &luminance}, options);
}

}  // namespace striae::reconstruct
