#include "acquire/rig/detail/exposure.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "acquire/rig/detail/bands.h"
#include "acquire/rig/detail/random.h"
#include "core/srgb.h"

namespace striae::rig::detail {
namespace {

constexpr int kBand = 32;
constexpr int kCurveSteps = 1 << 14;
constexpr float kLargest = 1 - 1e-6F;  // below 1, so that it falls into the last step

std::vector<std::uint8_t> SrgbCurve() {
  std::vector<std::uint8_t> curve(kCurveSteps);
  for (int i = 0; i < kCurveSteps; ++i) {
    const double x = (i + 0.5) / kCurveSteps;
    curve[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(255 * SrgbFromLight(x)));
  }
  return curve;
}

/// Half of a normalised Gaussian, from its middle outwards.
std::vector<float> Kernel(double sigma) {
  const int radius = static_cast<int>(std::ceil(3.5 * sigma));
  std::vector<double> weights;
  double sum = 0;
  for (int i = 0; i <= radius; ++i) {
    weights.push_back(sigma > 0 ? std::exp(-0.5 * i * i / (sigma * sigma)) : 1);
    sum += (i == 0 ? 1 : 2) * weights.back();
  }
  std::vector<float> kernel(weights.size());
  std::transform(weights.begin(), weights.end(), kernel.begin(),
                 [sum](double w) { return static_cast<float>(w / sum); });
  return kernel;
}

/// Which of some fifty Gaussians blurs each pixel.
class BlurLevels {
 public:
  explicit BlurLevels(const LensBlur& blur) : blur_(blur) {
    if (blur.aperture_fx <= 0) {
      kernels_ = {Kernel(blur.in_focus_px)};
    } else {
      for (int i = 0; i < kLevels; ++i) kernels_.push_back(Kernel(std::hypot(blur.in_focus_px, i * kLevel_px)));
    }
  }
  [[nodiscard]] const std::vector<float>& At(float depth_mm) const {
    if (kernels_.size() == 1 || !(depth_mm > 0)) return kernels_.front();
    const double deviation = blur_.aperture_fx * std::abs(1 / depth_mm - 1 / blur_.focus_mm) / 4;  // of the disc
    return kernels_[static_cast<std::size_t>(std::clamp(std::lround(deviation / kLevel_px), 0L, kLevels - 1L))];
  }
  /// The most that a picture of these depths needs.
  [[nodiscard]] int Radius(const ImageF& depth_mm) const {
    std::size_t most = kernels_.front().size();
    if (kernels_.size() > 1) {
      for (const float depth : depth_mm.pixels()) most = std::max(most, At(depth).size());
    }
    return static_cast<int>(most) - 1;
  }

 private:
  static constexpr int kLevels = 100;
  static constexpr double kLevel_px = 0.1;
  LensBlur blur_;
  std::vector<std::vector<float>> kernels_;
};

/// Weighted mean along x of the row, borders repeated.
void BlurRow(const LinearRgb* in, const float* depth, int width, const BlurLevels& levels, LinearRgb* out) {
  for (int x = 0; x < width; ++x) {
    const std::vector<float>& kernel = levels.At(depth[x]);
    const int radius = static_cast<int>(kernel.size()) - 1;
    for (std::size_t c = 0; c < 3; ++c) out[x][c] = kernel[0] * in[x][c];
    for (int i = 1; i <= radius; ++i) {
      const LinearRgb &left = in[std::max(0, x - i)], &right = in[std::min(width - 1, x + i)];
      for (std::size_t c = 0; c < 3; ++c) out[x][c] += kernel[static_cast<std::size_t>(i)] * (left[c] + right[c]);
    }
  }
}

/// Weighted mean along y of the rows around `row` of the band.
LinearRgb BlurColumn(const Image<LinearRgb>& band, int x, int row, const std::vector<float>& kernel) {
  LinearRgb value{};
  for (std::size_t c = 0; c < 3; ++c) value[c] = kernel[0] * band(x, row)[c];
  for (int i = 1; i < static_cast<int>(kernel.size()); ++i) {
    const LinearRgb &above = band(x, row - i), &below = band(x, row + i);
    for (std::size_t c = 0; c < 3; ++c) value[c] += kernel[static_cast<std::size_t>(i)] * (above[c] + below[c]);
  }
  return value;
}

}  // namespace

ImageRgb Expose(const Image<LinearRgb>& light, const ImageF& depth_mm, const SensorOptions& options,
                const LensBlur& blur, double pixel_area, int threads) {
  const int width = light.width(), height = light.height();
  const BlurLevels levels(blur);
  const int radius = levels.Radius(depth_mm);
  const std::vector<std::uint8_t> curve = SrgbCurve();
  const auto electrons = static_cast<float>(options.full_well_electrons * pixel_area * 200 / options.iso);
  const float read_variance = static_cast<float>(std::pow(options.read_noise_electrons / electrons, 2));
  ImageRgb picture(width, height);
  ForEachBand(height, kBand, threads, [&](int first, int last) {
    Image<LinearRgb> blurred(width, last - first + 2 * radius);
    for (int i = 0; i < blurred.height(); ++i) {
      const int row = std::clamp(first - radius + i, 0, height - 1);
      BlurRow(light.Row(row), depth_mm.Row(row), width, levels, blurred.Row(i));
    }
    for (int row = first; row < last; ++row) {
      Random random(options.seed * 0xD1342543DE82EF95U + static_cast<std::uint64_t>(row) * 0xA0761D6478BD642FU);
      for (int x = 0; x < width; ++x) {
        std::array<std::uint8_t, 3> bytes{};
        LinearRgb value = BlurColumn(blurred, x, row - first + radius, levels.At(depth_mm(x, row)));
        for (std::size_t c = 0; c < 3; ++c) {
          if (options.noise) value[c] += random.Normal() * std::sqrt(value[c] / electrons + read_variance);
          bytes[c] = curve[static_cast<std::size_t>(std::clamp(value[c], 0.0F, kLargest) * kCurveSteps)];
        }
        picture(x, row) = {bytes[0], bytes[1], bytes[2]};
      }
    }
  });
  return picture;
}

}  // namespace striae::rig::detail
