#include "reconstruct/detail/carrier.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reconstruct/detail/parallel.h"
#include "reconstruct/detail/transform.h"

namespace striae::reconstruct::detail {
namespace {

std::vector<double> MeanPowerSpectrum(const SampledLines& lines, int length) {
  const Plans plans(length);
  std::vector<float> hann(static_cast<std::size_t>(lines.length));
  for (int i = 0; i < lines.length; ++i) {
    hann[static_cast<std::size_t>(i)] =
        static_cast<float>(0.5 - 0.5 * std::cos(2 * std::numbers::pi * (i + 0.5) / lines.length));
  }
  // One sum for every block, added up in their order: the result does not depend on the number of threads.
  std::vector<std::vector<double>> sums(lines.blocks.size());
  ParallelBlocks(
      static_cast<int>(lines.blocks.size()),
      [&](int, int first, int last) {
        const auto real = RealArray(length);
        const auto spectrum = ComplexArray(length);
        for (int block = first; block < last; ++block) {
          auto& power = sums[static_cast<std::size_t>(block)];
          power.assign(static_cast<std::size_t>(length / 2), 0.0);
          const float* lanes = lines.blocks[static_cast<std::size_t>(block)].data();
          for (int lane = 0; lane < kLanes; ++lane) {
            const auto value = [&](int i) { return lanes[static_cast<std::size_t>(i) * kLanes + lane]; };
            double mean = 0;
            for (int i = 0; i < lines.length; ++i) mean += static_cast<double>(value(i));
            mean /= lines.length;
            std::fill(real.get() + lines.length, real.get() + length, 0.0F);
            for (int i = 0; i < lines.length; ++i) {
              real[static_cast<std::size_t>(i)] =
                  (value(i) - static_cast<float>(mean)) * hann[static_cast<std::size_t>(i)];
            }
            plans.Forward(real.get(), spectrum.get());
            for (std::size_t k = 0; k < power.size(); ++k) {
              power[k] += static_cast<double>(spectrum[k][0] * spectrum[k][0] + spectrum[k][1] * spectrum[k][1]);
            }
          }
        }
      },
      1);
  for (std::size_t block = 1; block < sums.size(); ++block) {
    for (std::size_t k = 0; k < sums[0].size(); ++k) sums[0][k] += sums[block][k];
  }
  return std::move(sums.front());
}

}  // namespace

SampledLines SampleLines(const ImageF& encoded, const LineLayout& layout, bool linear) {
  constexpr int kMostBlocks = 12;
  SampledLines sampled{layout.length(), {}};
  sampled.blocks.resize(static_cast<std::size_t>(std::min(kMostBlocks, layout.blocks())));
  const int count = static_cast<int>(sampled.blocks.size());
  const double step = static_cast<double>(layout.lines()) / (count * kLanes);
  ParallelBlocks(
      count,
      [&](int, int first, int last) {
        for (int block = first; block < last; ++block) {
          auto& lanes = sampled.blocks[static_cast<std::size_t>(block)];
          lanes.resize(static_cast<std::size_t>(layout.length()) * kLanes);
          layout.LoadLines(
              encoded, [&](int lane) { return static_cast<int>((block * kLanes + lane + 0.5) * step); }, lanes.data());
          if (!linear) DecodeSrgb(lanes.data(), lanes.size());
        }
      },
      1);
  return sampled;
}

std::optional<Carrier> FindCarrier(const SampledLines& lines) {
  constexpr double kShortestPeriod_px = 4, kFewestPeriods = 6;
  constexpr double kValley = 1.7;  // between the fundamental and its third harmonic, and as far below
  if (lines.length < 32 || lines.blocks.empty()) return std::nullopt;
  const int length = FastLength(lines.length);
  const std::vector<double> power = MeanPowerSpectrum(lines, length);
  // Smoothed over +-4 % of the frequency, because perspective and relief spread the carrier.
  std::vector<double> weighted(power.size(), 0.0);
  for (std::size_t k = 2; k < power.size(); ++k) {
    const auto reach = static_cast<std::size_t>(0.04 * static_cast<double>(k)) + 1;
    double sum = 0;
    const std::size_t first = k > reach ? k - reach : 0, last = std::min(power.size() - 1, k + reach);
    for (std::size_t j = first; j <= last; ++j) sum += power[j];
    weighted[k] = sum / static_cast<double>(last - first + 1) * static_cast<double>(k);
  }
  const auto lowest = static_cast<std::size_t>(std::ceil(kFewestPeriods * length / lines.length));
  const auto highest = std::min(power.size() - 2, static_cast<std::size_t>(length / kShortestPeriod_px));
  if (lowest >= highest) return std::nullopt;
  Carrier best;
  double best_height = 0;
  for (std::size_t k = lowest; k <= highest; ++k) {
    if (weighted[k] < weighted[k - 1] || weighted[k] < weighted[k + 1]) continue;
    const auto below = static_cast<std::size_t>(std::lround(static_cast<double>(k) / kValley));
    const auto above =
        std::min(power.size() - 1, static_cast<std::size_t>(std::lround(static_cast<double>(k) * kValley)));
    const double prominence = weighted[k] / std::max({weighted[below], weighted[above], 1e-30});
    if (prominence < 2 || weighted[k] <= best_height) continue;
    best_height = weighted[k];
    // Centre of gravity of the peak: finer than a bin.
    double sum = 0, moment = 0;
    const auto reach = static_cast<std::size_t>(0.15 * static_cast<double>(k)) + 1;
    for (std::size_t j = k - std::min(k, reach); j <= std::min(power.size() - 1, k + reach); ++j) {
      sum += power[j];
      moment += power[j] * static_cast<double>(j);
    }
    best = {length / (moment / sum), prominence};
  }
  if (best_height == 0) return std::nullopt;
  return best;
}

}  // namespace striae::reconstruct::detail
