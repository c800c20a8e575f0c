#include "reconstruct/detail/fourier.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "core/vector.h"
#include "reconstruct/detail/lane_mask.h"

namespace striae::reconstruct::detail {
namespace {

/// atan2 by a minimax polynomial of atan on [0, 1] (Abramowitz and Stegun 4.4.49), within 2e-8 of the true value before
/// float's rounding (2.4e-7 rad, a billionth of a mm of depth); without branches, so that it runs on vectors.
inline float ArcTangent(float y, float x) {
  constexpr float kHalfTurn = std::numbers::pi_v<float>;
  const float ax = std::abs(x), ay = std::abs(y);
  const float a = std::min(ax, ay) / (std::max(ax, ay) + 1e-30F), s = a * a;
  float r = 0.0028662257F;
  r = r * s - 0.0161657367F;
  r = r * s + 0.0429096138F;
  r = r * s - 0.0752896400F;
  r = r * s + 0.1065626393F;
  r = r * s - 0.1420889944F;
  r = r * s + 0.1999355085F;
  r = r * s - 0.3333314528F;
  r = r * s + 1.0F;
  r *= a;
  r = ay > ax ? kHalfTurn / 2 - r : r;
  r = x < 0 ? kHalfTurn - r : r;
  return std::copysign(r, y);
}

STRIAE_VECTORISED void ToPolar(const fftwf_complex* signal, int length, float* __restrict phase,
                               float* __restrict amplitude, float* __restrict stripes) {
  const float* __restrict z = &signal[0][0];
  for (std::size_t i = 0; i < static_cast<std::size_t>(length); ++i) {
    const float re = z[2 * i], im = z[2 * i + 1];
    phase[i] = ArcTangent(im, re);
    amplitude[i] = std::sqrt(re * re + im * im);
    stripes[i] = re;
  }
}

constexpr float kLitShare = 0.25F;  ///< of the brightest background: light has shot noise, darkness has less
constexpr double kLeastLit = 0.05;  ///< of a line

/// Share of a lane's positions that are at least so bright.
double LitShare(const float* lane, int length, float least) {
  int lit = 0;
  for (int i = 0; i < length; ++i) lit += lane[static_cast<std::size_t>(i) * kLanes] >= least ? 1 : 0;
  return static_cast<double>(lit) / length;
}

}  // namespace

LineAnalysis::LineAnalysis(int length, double period_px, const BandWindow& window, bool remove_background)
    : length_(length),
      // Two periods: as far as the window's kernel reaches, lest the line's end be mixed with its start.
      padded_(FastLength(length + static_cast<int>(std::ceil(2 * period_px)))),
      period_px_(period_px),
      remove_background_(remove_background),
      plans_(padded_) {
  const double center = padded_ / period_px;
  first_ = std::max(1, static_cast<int>(std::ceil(center * (1 - window.half_width))));
  const int last = std::min(padded_ / 2 - 1, static_cast<int>(std::floor(center * (1 + window.half_width))));
  for (int k = first_; k <= last; ++k) {
    const double x = (k - center) / (center * window.half_width);
    const double hann = (1 + std::cos(std::numbers::pi * x)) / 2;
    window_.push_back(static_cast<float>(2 * (window.flattened ? hann * (2 - hann) : hann) / padded_));
  }
}

LineAnalysis::Scratch::Scratch(const LineAnalysis& analysis)
    : lines(RealArray(analysis.length_ * kLanes)),
      amplitudes(RealArray(analysis.length_ * kLanes)),
      stripes(RealArray(analysis.length_ * kLanes)),
      real(RealArray(analysis.padded_)),
      spectrum(ComplexArray(analysis.padded_)),
      signal(ComplexArray(analysis.padded_)),
      once(static_cast<std::size_t>(analysis.length_) * kLanes) {}

void LineAnalysis::Transform(const float* line, Scratch& scratch) const {
  std::copy(line, line + length_, scratch.real.get());
  std::fill(scratch.real.get() + length_, scratch.real.get() + padded_, 0.0F);
  plans_.Forward(scratch.real.get(), scratch.spectrum.get());
}

void LineAnalysis::Background(const float* light, float* background, Scratch& scratch) const {
  BoxMean(light, scratch.once.data(), length_, period_px_);
  BoxMean(scratch.once.data(), background, length_, period_px_);
}

bool LineAnalysis::Unlit(const float* light, float least_amplitude, float least_modulation) const {
  // Means over a quarter of a period keep 0.9 of a sinusoid's amplitude, and two pairs of them half a period apart give
  // it whatever its phase. Along the stripes the phase turns with the surface: over 16 lines, at grazing incidence,
  // half of the amplitude may be lost.
  constexpr float kLeastShare = 0.45F;
  const std::vector<float> m = GroupMeans(light, length_, std::max(1, static_cast<int>(std::lround(period_px_ / 4))));
  if (m.size() < 8) return false;
  float largest = 0, darkest = m[0];
  for (std::size_t i = 0; i + 3 < m.size(); ++i) {
    largest = std::max(largest, 0.5F * std::hypot(m[i] - m[i + 2], m[i + 1] - m[i + 3]));
    darkest = std::min(darkest, 0.25F * (m[i] + m[i + 1] + m[i + 2] + m[i + 3]));
  }
  return largest < kLeastShare * std::max(least_amplitude, least_modulation * darkest);
}

void LineAnalysis::Stripes(const float* light, const Signal& out, Scratch& scratch) const {
  const auto stride = static_cast<std::size_t>(length_);
  if (!remove_background_) std::fill(scratch.once.begin(), scratch.once.end(), 0.0F);
  const float* background = remove_background_ ? out.background : scratch.once.data();
  SubtractToLines(light, background, length_, scratch.lines.get(), stride);
  float *phases = scratch.lines.get(),
        *amplitudes = scratch.amplitudes.get();  // a line is done with when it is transformed
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    Transform(scratch.lines.get() + lane * stride, scratch);
    fftwf_complex *spectrum = scratch.spectrum.get(), *band = scratch.signal.get();
    for (std::size_t k = 0; k < window_.size(); ++k) {
      spectrum[static_cast<std::size_t>(first_) + k][0] *= window_[k];
      spectrum[static_cast<std::size_t>(first_) + k][1] *= window_[k];
    }
    std::memset(spectrum, 0, sizeof(fftwf_complex) * static_cast<std::size_t>(first_));
    const std::size_t behind = static_cast<std::size_t>(first_) + window_.size();
    std::memset(spectrum + behind, 0, sizeof(fftwf_complex) * (static_cast<std::size_t>(padded_) - behind));
    plans_.Inverse(spectrum, band);
    ToPolar(band, length_, phases + lane * stride, amplitudes + lane * stride, scratch.stripes.get() + lane * stride);
  }
  LinesToLanes(phases, stride, length_, out.phase);
  LinesToLanes(amplitudes, stride, length_, out.amplitude);
  LinesToLanes(scratch.stripes.get(), stride, length_, out.stripes);
}

void LineAnalysis::Misfit(const float* light, const Signal& signal, std::uint8_t* misfit, Scratch& scratch) const {
  const int group = std::max(1, static_cast<int>(std::lround(period_px_ / 8)));
  LaneMisfit(light, signal.background, signal.stripes, length_, group, scratch.groups, misfit);
}

double LineAnalysis::Noise(const std::vector<Lanes<float>>& blocks) const {
  const int first = static_cast<int>(0.4 * padded_), last = static_cast<int>(0.49 * padded_);
  const auto stride = static_cast<std::size_t>(length_);
  Scratch scratch(*this);
  std::vector<Lanes<float>> backgrounds(blocks.size(), Lanes<float>(stride * kLanes));
  float brightest = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    Background(blocks[b].data(), backgrounds[b].data(), scratch);
    brightest = std::max(brightest, *std::max_element(backgrounds[b].begin(), backgrounds[b].end()));
  }
  std::vector<double> lit, all;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    SubtractToLines(blocks[b].data(), backgrounds[b].data(), length_, scratch.lines.get(), stride);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      Transform(scratch.lines.get() + lane * stride, scratch);
      double sum = 0;
      for (int k = first; k < last; ++k) {
        const double re = scratch.spectrum[static_cast<std::size_t>(k)][0];
        const double im = scratch.spectrum[static_cast<std::size_t>(k)][1];
        sum += re * re + im * im;
      }
      all.push_back(sum / (last - first));
      const double share = LitShare(backgrounds[b].data() + lane, length_, kLitShare * brightest);
      if (share > kLeastLit) lit.push_back(all.back() / share);
    }
  }
  // White noise of variance s2 gives each bin length * s2; the window keeps sum(w^2) of it in either component.
  double kept = 0;
  for (const float w : window_) kept += static_cast<double>(w) * static_cast<double>(w);
  std::vector<double>& power = lit.size() >= kLanes ? lit : all;
  const auto middle = power.begin() + static_cast<long>(power.size() / 2);
  std::nth_element(power.begin(), middle, power.end());
  return std::sqrt(*middle * kept / 2);
}

}  // namespace striae::reconstruct::detail
