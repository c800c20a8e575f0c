#include "reconstruct/detail/line_block.h"

#include <algorithm>
#include <cmath>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "core/vector.h"
#include "reconstruct/detail/lane_types.h"

namespace striae::reconstruct::detail {
STRIAE_VECTORISED void DecodeSrgb(float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const float x = std::min(std::max(values[i], 0.0F), 1.0F);
    // Chebyshev interpolation of ((x + 0.055) / 1.055)^2.4 over [0.04045, 1]; largest error 7.6e-7.
    float y = -0.06936492461840255F;
    y = y * x + 0.3447260345593203F;
    y = y * x - 0.748934319425825F;
    y = y * x + 0.9590580301542184F;
    y = y * x - 0.8699634283256948F;
    y = y * x + 0.8628650678609223F;
    y = y * x + 0.48547653236920857F;
    y = y * x + 0.0352814210872205F;
    y = y * x + 0.0008552189917855F;
    values[i] = x <= 0.04045F ? x * (1 / 12.92F) : y;
  }
}

void CopyRows(const float* from, std::size_t from_stride, int rows, int width, float* to, std::size_t to_stride) {
  if (width != kLanes) {
    for (int row = 0; row < rows; ++row, from += from_stride, to += to_stride) std::copy_n(from, width, to);
    return;
  }
#if defined(__SSE__)
  // Past the cache: nothing reads it before the whole image is written. Whole cache lines only, or it would be slower.
  if (to_stride > kLanes && reinterpret_cast<std::uintptr_t>(to) % 64 == 0 && to_stride % 16 == 0) {
    for (int row = 0; row < rows; ++row, from += from_stride, to += to_stride) {
      for (int k = 0; k < kLanes; k += 4) _mm_stream_ps(to + k, _mm_loadu_ps(from + k));
    }
    _mm_sfence();
    return;
  }
#endif
  constexpr int kAhead = 12;  // rows; see PrefetchRow
  for (int row = 0; row < rows; ++row, from += from_stride, to += to_stride) {
    if (row + kAhead < rows) __builtin_prefetch(from + kAhead * from_stride);
    STRIAE_LANES(Floats, to) = STRIAE_LANES(const Floats, from);
  }
}

void LineLayout::LoadWithHalo(const ImageF& image, int block, int halo, float* out) const {
  const int first = block * kLanes - halo, count = kLanes + 2 * halo, last_line = lines() - 1;
  const auto stride = static_cast<std::size_t>(count);
  if (along_columns_ && first >= 0 && first + count <= lines()) {
    CopyRows(image.Row(0) + first, static_cast<std::size_t>(width_), length(), count, out, stride);
    return;
  }
  for (int lane = 0; lane < count; ++lane) {
    const int line = std::clamp(first + lane, 0, last_line);
    float* to = out + lane;
    for (int position = 0; position < length(); ++position, to += stride) {
      *to = along_columns_ ? image(line, position) : image(position, line);
    }
  }
}

STRIAE_VECTORISED std::size_t CountAtLeast(const float* with_halo, int length, int halo, int lanes, float level) {
  const auto stride = static_cast<std::size_t>(kLanes + 2 * halo);
  Ints count{};
  for (int i = 0; i < length; ++i) {
    count -= STRIAE_LANES(const Floats, with_halo + static_cast<std::size_t>(i) * stride + halo) >= level;
  }
  std::size_t sum = 0;
  for (int lane = 0; lane < lanes; ++lane) sum += static_cast<std::size_t>(count[static_cast<std::size_t>(lane)]);
  return sum;
}

std::vector<float> GaussianKernel(double sigma_px) {
  constexpr double kReach = 3.7;  // standard deviations: exp(-kReach^2 / 2) is a thousandth
  const int halo = static_cast<int>(std::floor(kReach * sigma_px));
  std::vector<double> half;
  double sum = 0;
  for (int k = 0; k <= halo; ++k) {
    half.push_back(k == 0 ? 1 : std::exp(-k * k / (2 * sigma_px * sigma_px)));
    sum += (k == 0 ? 1 : 2) * half.back();
  }
  std::vector<float> kernel;
  for (const double value : half) kernel.push_back(static_cast<float>(value / sum));
  return kernel;
}

STRIAE_VECTORISED void SmoothAcross(const float* with_halo, int length, const std::vector<float>& kernel,
                                    float* lanes) {
  const int halo = static_cast<int>(kernel.size()) - 1;
  const auto stride = static_cast<std::size_t>(kLanes + 2 * halo);
  for (int i = 0; i < length; ++i) {
    const float* middle = with_halo + static_cast<std::size_t>(i) * stride + halo;
    Floats sum = kernel[0] * STRIAE_LANES(const Floats, middle);
    for (int k = 1; k <= halo; ++k) {
      sum += kernel[static_cast<std::size_t>(k)] *
             (STRIAE_LANES(const Floats, middle - k) + STRIAE_LANES(const Floats, middle + k));
    }
    STRIAE_LANES(Floats, lanes + At(i)) = sum;
  }
}

STRIAE_VECTORISED void BoxMean(const float* in, float* out, int length, double period_px) {
  const int half = std::max(0, static_cast<int>(std::floor((period_px - 1) / 2)));
  const auto rest = static_cast<float>((period_px - 1) / 2 - half);  // of the pixels beyond the whole ones
  const auto scale = static_cast<float>(1 / period_px);
  const auto row = [&](int position) { return in + At(std::clamp(position, 0, length - 1)); };
  // In single precision the sum drifts by half an ulp a step: over a line of 4000 a millionth of the mean.
  Floats sum{};
  for (int k = -half; k <= half; ++k) sum += STRIAE_LANES(const Floats, row(k));
  const auto step = [&](int i, const float* before, const float* leaving, const float* coming) {
    const Floats beside = STRIAE_LANES(const Floats, before) + STRIAE_LANES(const Floats, coming);
    STRIAE_LANES(Floats, out + At(i)) = (sum + rest * beside) * scale;
    sum += STRIAE_LANES(const Floats, coming) - STRIAE_LANES(const Floats, leaving);
  };
  const int begin = std::min(half + 1, length), end = std::max(begin, length - half - 1);
  for (int i = 0; i < begin; ++i) step(i, row(i - half - 1), row(i - half), row(i + half + 1));
  for (int i = begin; i < end; ++i) step(i, in + At(i - half - 1), in + At(i - half), in + At(i + half + 1));
  for (int i = end; i < length; ++i) step(i, row(i - half - 1), row(i - half), row(i + half + 1));
}

STRIAE_VECTORISED std::vector<float> GroupMeans(const float* in, int length, int group) {
  std::vector<float> means(static_cast<std::size_t>(length / group));
  const float scale = 1 / static_cast<float>(group * kLanes);
  for (std::size_t g = 0; g < means.size(); ++g) {
    Floats sum{};
    for (int k = 0; k < group; ++k) sum += STRIAE_LANES(const Floats, in + At(static_cast<int>(g) * group + k));
    float all = 0;
    for (int lane = 0; lane < kLanes; ++lane) all += sum[static_cast<std::size_t>(lane)];
    means[g] = scale * all;
  }
  return means;
}

STRIAE_VECTORISED void SubtractToLines(const float* a, const float* b, int length, float* out, std::size_t stride) {
  for (int i = 0; i < length; ++i) {
    const Floats difference = STRIAE_LANES(const Floats, a + At(i)) - STRIAE_LANES(const Floats, b + At(i));
    float* to = out + i;
    for (std::size_t l = 0; l < kLanes; ++l) to[l * stride] = difference[l];
  }
}

STRIAE_VECTORISED void LinesToLanes(const float* in, std::size_t stride, int length, float* out) {
  for (int i = 0; i < length; ++i) {
    Floats value{};
    for (std::size_t l = 0; l < kLanes; ++l) value[l] = in[l * stride + static_cast<std::size_t>(i)];
    STRIAE_LANES(Floats, out + At(i)) = value;
  }
}

}  // namespace striae::reconstruct::detail
