#include "reconstruct/detail/fourier.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <mutex>
#include <numbers>
#include <vector>

#include <fftw3.h>

#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {
namespace {

struct FreeFftw {
  void operator()(void* memory) const { fftwf_free(memory); }
};
template <typename T>
using FftwArray = std::unique_ptr<T[], FreeFftw>;

FftwArray<float> RealArray(int size) { return FftwArray<float>(fftwf_alloc_real(static_cast<std::size_t>(size))); }
FftwArray<fftwf_complex> ComplexArray(int size) {
  return FftwArray<fftwf_complex>(fftwf_alloc_complex(static_cast<std::size_t>(size)));
}

/// Only planning is not thread-safe in FFTW; plans are made here one at a time.
class Plans {
 public:
  explicit Plans(int length) {
    const auto real = RealArray(length);
    const auto a = ComplexArray(length), b = ComplexArray(length);
    const std::lock_guard lock(Mutex());
    forward_ = fftwf_plan_dft_r2c_1d(length, real.get(), a.get(), FFTW_ESTIMATE);
    inverse_ = fftwf_plan_dft_1d(length, a.get(), b.get(), FFTW_BACKWARD, FFTW_ESTIMATE);
  }
  ~Plans() {
    const std::lock_guard lock(Mutex());
    fftwf_destroy_plan(forward_);
    fftwf_destroy_plan(inverse_);
  }
  Plans(const Plans&) = delete;
  Plans& operator=(const Plans&) = delete;
  void Forward(float* in, fftwf_complex* out) const { fftwf_execute_dft_r2c(forward_, in, out); }
  void Inverse(fftwf_complex* in, fftwf_complex* out) const { fftwf_execute_dft(inverse_, in, out); }

 private:
  static std::mutex& Mutex() {
    static std::mutex mutex;
    return mutex;
  }
  fftwf_plan forward_ = nullptr, inverse_ = nullptr;
};

/// The next length with factors 2, 3, 5 only: 4288 and 2848 have large primes, which FFTW does several times slower.
int FastLength(int least) {
  for (int length = least;; ++length) {
    int rest = length;
    for (const int factor : {2, 3, 5}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return length;
  }
}

/// Running mean over `period_px` (fractional), applied twice: a triangle that is zero at the carrier's frequency and
/// its harmonics. The ends repeat the border value.
class LocalMean {
 public:
  LocalMean(int length, double period_px)
      : sums_(static_cast<std::size_t>(length) + 1), once_(static_cast<std::size_t>(length)), half_(period_px / 2) {}

  void operator()(const float* in, float* out, int length) {
    Box(in, once_.data(), length);
    Box(once_.data(), out, length);
  }

 private:
  void Box(const float* in, float* out, int length) {
    sums_[0] = 0;
    for (int i = 0; i < length; ++i)
      sums_[static_cast<std::size_t>(i) + 1] = sums_[static_cast<std::size_t>(i)] + in[i];
    for (int i = 0; i < length; ++i) {
      const double from = i + 0.5 - half_, to = i + 0.5 + half_;
      out[i] = static_cast<float>((IntegralTo(to, in, length) - IntegralTo(from, in, length)) / (to - from));
    }
  }
  /// Integral of the step function from 0 to x, the ends continued.
  [[nodiscard]] double IntegralTo(double x, const float* in, int length) const {
    if (x <= 0) return x * in[0];
    if (x >= length) return sums_[static_cast<std::size_t>(length)] + (x - length) * in[length - 1];
    const auto whole = static_cast<std::size_t>(x);
    return sums_[whole] + (x - static_cast<double>(whole)) * in[whole];
  }

  std::vector<double> sums_;
  std::vector<float> once_;
  double half_;
};

/// atan2 by a minimax polynomial of atan on [0, 1] (Abramowitz and Stegun 4.4.49), within 2e-8 of the true value before
/// float's rounding (2.4e-7 rad, a billionth of a mm of depth); without branches, so that it runs on vectors.
float ArcTangent(float y, float x) {
  constexpr float kHalfTurn = std::numbers::pi_v<float>;
  const float ax = std::abs(x), ay = std::abs(y);
  const float a = std::min(ax, ay) / (std::max(ax, ay) + 1e-30F), s = a * a;
  float r = 0.0028662257F;
  for (const float c : {-0.0161657367F, 0.0429096138F, -0.0752896400F, 0.1065626393F, -0.1420889944F, 0.1999355085F,
                        -0.3333314528F, 1.0F}) {
    r = r * s + c;
  }
  r *= a;
  r = ay > ax ? kHalfTurn / 2 - r : r;
  r = x < 0 ? kHalfTurn - r : r;
  return std::copysign(r, y);
}

std::vector<double> MeanPowerSpectrum(const ImageF& lines, int length) {
  constexpr int kMostLines = 192;
  const int step = std::max(1, lines.height() / kMostLines);
  const Plans plans(length);
  const auto real = RealArray(length);
  const auto spectrum = ComplexArray(length);
  std::vector<double> power(static_cast<std::size_t>(length / 2), 0.0);
  for (int line = step / 2; line < lines.height(); line += step) {
    const float* in = lines.Row(line);
    double mean = 0;
    for (int i = 0; i < lines.width(); ++i) mean += in[i];
    mean /= lines.width();
    for (int i = 0; i < length; ++i) {
      const double hann = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (i + 0.5) / lines.width());
      real[static_cast<std::size_t>(i)] = i < lines.width() ? static_cast<float>((in[i] - mean) * hann) : 0.0F;
    }
    plans.Forward(real.get(), spectrum.get());
    for (std::size_t k = 0; k < power.size(); ++k) {
      power[k] += spectrum[k][0] * spectrum[k][0] + spectrum[k][1] * spectrum[k][1];
    }
  }
  return power;
}

}  // namespace

std::optional<Carrier> FindCarrier(const ImageF& lines) {
  constexpr double kShortestPeriod_px = 4, kFewestPeriods = 6;
  constexpr double kValley = 1.7;  // between the fundamental and its third harmonic, and as far below
  if (lines.width() < 32 || lines.height() < 1) return std::nullopt;
  const int length = FastLength(lines.width());
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
  const auto lowest = static_cast<std::size_t>(std::ceil(kFewestPeriods * length / lines.width()));
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

AnalyticSignal AnalyseLines(const ImageF& lines, double period_px, double half_width) {
  const int width = lines.width(), height = lines.height();
  const int length = FastLength(width + static_cast<int>(std::ceil(2 * period_px)));
  const Plans plans(length);
  const double center = length / period_px;
  const int first = std::max(1, static_cast<int>(std::ceil(center * (1 - half_width))));
  const int last = std::min(length / 2 - 1, static_cast<int>(std::floor(center * (1 + half_width))));
  std::vector<float> window;
  for (int k = first; k <= last; ++k) {
    const double x = (k - center) / (center * half_width);
    window.push_back(static_cast<float>((1 + std::cos(std::numbers::pi * x)) / length));  // 2 * Hann / length
  }
  AnalyticSignal out{ImageF(width, height), ImageF(width, height), ImageF(width, height), 0};
  std::vector<double> noise_power(static_cast<std::size_t>(height), 0.0);
  const int noise_first = static_cast<int>(0.4 * length), noise_last = static_cast<int>(0.49 * length);
  ParallelBlocks(height, [&](int, int begin, int end) {
    const auto real = RealArray(length);
    const auto spectrum = ComplexArray(length), band = ComplexArray(length);
    LocalMean local_mean(width, period_px);
    for (int line = begin; line < end; ++line) {
      const float* in = lines.Row(line);
      float* background = out.background.Row(line);
      local_mean(in, background, width);
      for (int i = 0; i < width; ++i) real[static_cast<std::size_t>(i)] = in[i] - background[i];
      std::fill(real.get() + width, real.get() + length, 0.0F);
      plans.Forward(real.get(), spectrum.get());
      double power = 0;
      for (int k = noise_first; k < noise_last; ++k)
        power += std::norm(std::complex<double>(spectrum[k][0], spectrum[k][1]));
      noise_power[static_cast<std::size_t>(line)] = power / (noise_last - noise_first);
      std::fill(&band[0][0], &band[0][0] + 2 * static_cast<std::size_t>(length), 0.0F);
      for (int k = first; k <= last; ++k) {
        const float w = window[static_cast<std::size_t>(k - first)];
        band[k][0] = spectrum[k][0] * w;
        band[k][1] = spectrum[k][1] * w;
      }
      plans.Inverse(band.get(), spectrum.get());
      float *phase = out.phase.Row(line), *amplitude = out.amplitude.Row(line);
      for (int i = 0; i < width; ++i) {
        const float re = spectrum[i][0], im = spectrum[i][1];
        phase[i] = ArcTangent(im, re);
        amplitude[i] = std::sqrt(re * re + im * im);
      }
    }
  });
  // White noise of variance s2 gives each bin length * s2; the window keeps sum(w^2) of it in either component.
  double kept = 0;
  for (const float w : window) kept += static_cast<double>(w) * w;
  std::nth_element(noise_power.begin(), noise_power.begin() + height / 2, noise_power.end());
  out.noise = std::sqrt(noise_power[static_cast<std::size_t>(height / 2)] * kept / 2);
  return out;
}

}  // namespace striae::reconstruct::detail
