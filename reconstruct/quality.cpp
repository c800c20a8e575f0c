#include "reconstruct/quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct {
namespace {

constexpr double kTilePeriods = 12;
constexpr double kRival = 0.04;  // power of the second pattern over that of the stripes

/// Frequencies as shares of the carrier's at which the periodogram is taken, half a bin apart.
constexpr double kLowest = 0.3, kHighest = 1.8, kFrequencyStep = 0.5 / kTilePeriods;
constexpr std::size_t kFrequencies = static_cast<std::size_t>((kHighest - kLowest) / kFrequencyStep) + 1;

using Spectrum = std::array<double, kFrequencies>;

double FrequencyAt(std::size_t i) { return kLowest + kFrequencyStep * static_cast<double>(i); }

/// Pixels along (x) and beside (line) the direction across the stripes.
class Lines {
 public:
  explicit Lines(const PhaseResult& phase) : horizontal_(phase.direction == StripeDirection::kHorizontal) {
    length_ = horizontal_ ? phase.mask.height() : phase.mask.width();
    count_ = horizontal_ ? phase.mask.width() : phase.mask.height();
  }
  [[nodiscard]] int length() const { return length_; }
  [[nodiscard]] int count() const { return count_; }
  template <typename T>
  [[nodiscard]] T At(const Image<T>& image, int line, int x) const {
    return horizontal_ ? image(line, x) : image(x, line);
  }

 private:
  bool horizontal_;
  int length_ = 0, count_ = 0;
};

/// Cosine and sine times the window for every frequency and pixel of a tile's line.
class Probe {
 public:
  explicit Probe(double period_px)
      : length_(static_cast<int>(std::lround(kTilePeriods * period_px))),
        cosine_(kFrequencies * size()),
        sine_(cosine_) {
    for (std::size_t i = 0; i < light_.size(); ++i) light_[i] = std::pow(static_cast<float>(i) / 255, 2.2F);
    for (std::size_t f = 0; f < kFrequencies; ++f) {
      for (std::size_t x = 0; x < size(); ++x) {
        const double window = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (static_cast<double>(x) + 0.5) / length_);
        const double angle = 2 * std::numbers::pi * FrequencyAt(f) / period_px * static_cast<double>(x);
        cosine_[f * size() + x] = static_cast<float>(window * std::cos(angle));
        sine_[f * size() + x] = static_cast<float>(window * std::sin(angle));
      }
    }
  }
  [[nodiscard]] int length() const { return length_; }
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(length_); }
  [[nodiscard]] float LightOf(std::uint8_t encoded) const { return light_[encoded]; }

  void AddPower(const std::vector<float>& signal, Spectrum& power) const {
    for (std::size_t f = 0; f < kFrequencies; ++f) {
      const float *c = &cosine_[f * size()], *s = &sine_[f * size()];
      float real = 0, imaginary = 0;
      for (std::size_t x = 0; x < size(); ++x) {
        real += signal[x] * c[x];
        imaginary += signal[x] * s[x];
      }
      power[f] += real * real + imaginary * imaginary;
    }
  }

 private:
  int length_;
  std::vector<float> cosine_, sine_;
  std::array<float, 256> light_;  ///< of an encoded value
};

/// Power of a tile over its lines; false when too much of it is not measured.
bool TilePower(const Photograph& photograph, const PhaseResult& phase, const Lines& lines, const Probe& probe, int line,
               int x, Spectrum& power) {
  constexpr int kLinesPerTile = 4, kBetween = 8;
  power = {};
  std::vector<float> signal(probe.size());
  for (int k = 0; k < kLinesPerTile; ++k) {
    const int at = line + k * kBetween;
    if (at >= lines.count()) return false;
    for (int i = 0; i < probe.length(); ++i) {
      if (lines.At(phase.mask, at, x + i) == 0) return false;
      const Rgb8 pixel = lines.At(photograph.colour, at, x + i);
      const float light =
          0.2126F * probe.LightOf(pixel.r) + 0.7152F * probe.LightOf(pixel.g) + 0.0722F * probe.LightOf(pixel.b);
      signal[static_cast<std::size_t>(i)] = light / std::max(lines.At(phase.background, at, x + i), 1e-4F) - 1;
    }
    probe.AddPower(signal, power);
  }
  return true;
}

/// Frequency (share of the carrier's) of the pattern beside the stripes, 0 when there is none.
double SecondPattern(const Spectrum& power) {
  const auto main = static_cast<std::size_t>(std::max_element(power.begin(), power.end()) - power.begin());
  const double stripes = FrequencyAt(main);
  double best = 0, at = 0;
  for (std::size_t i = 1; i + 1 < kFrequencies; ++i) {
    if (power[i] <= power[i - 1] || power[i] < power[i + 1]) continue;  // peaks alone
    // Hann's own peak is two bins to either side; a slope or a distance that changes within the tile widens it.
    if (std::abs(FrequencyAt(i) - stripes) < 2.5 / kTilePeriods) continue;
    if (power[i] > best) {
      best = power[i];
      at = FrequencyAt(i);
    }
  }
  return best > kRival * power[main] ? at : 0;
}

double WellLitModulation(const PhaseResult& phase) {
  std::vector<float> values;
  for (std::size_t i = 0; i < phase.mask.size(); i += 17) {
    if (phase.mask.pixels()[i] != 0) values.push_back(phase.ModulationAt(i));
  }
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<long>(3 * values.size() / 4);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::string Percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

}  // namespace

PhotographQuality JudgePhotograph(const Photograph& photograph, const PhaseResult& phase) {
  constexpr double kFlat = 0.3, kManyTiles = 0.1;
  constexpr std::size_t kFewestTiles = 6;
  PhotographQuality quality;
  quality.modulation = WellLitModulation(phase);
  const Lines lines(phase);
  const Probe probe(phase.carrier_period_px);
  const int step = std::max(32, lines.count() / 16);  // tiles here and there tell as much as all would
  struct OfLine {
    std::size_t tiles = 0;
    std::vector<double> seconds;
  };
  std::vector<OfLine> found(static_cast<std::size_t>((lines.count() + step - 1) / step));
  detail::ParallelBlocks(
      static_cast<int>(found.size()),
      [&](int, int first, int) {
        OfLine& here = found[static_cast<std::size_t>(first)];
        Spectrum power;
        for (int x = 0; x + probe.length() <= lines.length(); x += probe.length()) {
          if (!TilePower(photograph, phase, lines, probe, first * step, x, power)) continue;
          ++here.tiles;
          if (const double second = SecondPattern(power); second > 0) here.seconds.push_back(second);
        }
      },
      1);
  std::size_t tiles = 0;
  std::vector<double> seconds;
  for (const OfLine& line : found) {
    tiles += line.tiles;
    seconds.insert(seconds.end(), line.seconds.begin(), line.seconds.end());
  }
  if (tiles > 0) quality.second_pattern_share = static_cast<double>(seconds.size()) / static_cast<double>(tiles);
  if (!seconds.empty()) {
    const auto middle = seconds.begin() + static_cast<long>(seconds.size() / 2);
    std::nth_element(seconds.begin(), middle, seconds.end());
    quality.second_period_px = phase.carrier_period_px / *middle;
  }
  if (tiles >= kFewestTiles && quality.second_pattern_share > kManyTiles) {
    quality.warnings.push_back(
        "a second pattern of about " + std::to_string(std::lround(quality.second_period_px)) +
        " px period shows beside the stripes on " + Percent(quality.second_pattern_share) +
        " of the surface and bends its phase there; cover or take off striped and checked cloth, switch off other "
        "projectors");
  }
  if (quality.modulation > 0 && quality.modulation < kFlat) {
    quality.warnings.push_back("the stripes have only " + Percent(quality.modulation) +
                               " contrast; the photograph is out of focus or blurred by motion, or the room is too "
                               "bright: focus by hand on the subject, hold still, dim the lights");
  }
  return quality;
}

}  // namespace striae::reconstruct
