#include "acquire/rig/detail/exposure.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "acquire/rig/detail/bands.h"
#include "acquire/rig/detail/random.h"

namespace striae::rig::detail {
namespace {

constexpr int kBand = 16;
constexpr int kCurveSteps = 1 << 14;
constexpr float kLargest = 1 - 1e-6F;  // below 1, so that it falls into the last step

std::vector<std::uint8_t> SrgbCurve() {
  std::vector<std::uint8_t> curve(kCurveSteps);
  for (int i = 0; i < kCurveSteps; ++i) {
    const double x = (i + 0.5) / kCurveSteps;
    const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    curve[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(255 * encoded));
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

/// Weighted mean along x of the row, borders repeated.
void BlurRow(const LinearRgb* in, int width, const std::vector<float>& kernel, LinearRgb* out) {
  const int radius = static_cast<int>(kernel.size()) - 1;
  for (int x = 0; x < width; ++x) {
    for (std::size_t c = 0; c < 3; ++c) out[x][c] = kernel[0] * in[x][c];
    for (int i = 1; i <= radius; ++i) {
      const LinearRgb &left = in[std::max(0, x - i)], &right = in[std::min(width - 1, x + i)];
      for (std::size_t c = 0; c < 3; ++c) out[x][c] += kernel[static_cast<std::size_t>(i)] * (left[c] + right[c]);
    }
  }
}

}  // namespace

ImageRgb Expose(const Image<LinearRgb>& light, const SensorOptions& options, double blur_px, double pixel_area,
                int threads) {
  const int width = light.width(), height = light.height();
  const std::vector<float> kernel = Kernel(blur_px);
  const int radius = static_cast<int>(kernel.size()) - 1;
  const std::vector<std::uint8_t> curve = SrgbCurve();
  const auto electrons = static_cast<float>(options.full_well_electrons * pixel_area * 200 / options.iso);
  const float read_variance = static_cast<float>(std::pow(options.read_noise_electrons / electrons, 2));
  ImageRgb picture(width, height);
  ForEachBand(height, kBand, threads, [&](int first, int last) {
    Image<LinearRgb> blurred(width, last - first + 2 * radius);
    for (int i = 0; i < blurred.height(); ++i) {
      BlurRow(light.Row(std::clamp(first - radius + i, 0, height - 1)), width, kernel, blurred.Row(i));
    }
    for (int row = first; row < last; ++row) {
      Random random(options.seed * 0xD1342543DE82EF95U + static_cast<std::uint64_t>(row) * 0xA0761D6478BD642FU);
      for (int x = 0; x < width; ++x) {
        std::array<std::uint8_t, 3> bytes{};
        for (std::size_t c = 0; c < 3; ++c) {
          float value = kernel[0] * blurred(x, row - first + radius)[c];
          for (int i = 1; i <= radius; ++i) {
            value += kernel[static_cast<std::size_t>(i)] *
                     (blurred(x, row - first + radius - i)[c] + blurred(x, row - first + radius + i)[c]);
          }
          if (options.noise) value += random.Normal() * std::sqrt(value / electrons + read_variance);
          bytes[c] = curve[static_cast<std::size_t>(std::clamp(value, 0.0F, kLargest) * kCurveSteps)];
        }
        picture(x, row) = {bytes[0], bytes[1], bytes[2]};
      }
    }
  });
  return picture;
}

}  // namespace striae::rig::detail
