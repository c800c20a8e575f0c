#include "reconstruct/detail/line_block.h"

#include <algorithm>
#include <cmath>
#include <limits>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "core/vector.h"

namespace striae::reconstruct::detail {
namespace {

constexpr std::size_t At(int position) { return static_cast<std::size_t>(position) * kLanes; }

// One value of every lane (GCC's and clang's vector types: arithmetic is by lane, a comparison gives 0 or -1).
using Floats = float __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));
using Ints = std::int32_t __attribute__((vector_size(4 * kLanes)));
using Shorts = std::uint16_t __attribute__((vector_size(2 * kLanes), aligned(2), may_alias));
using Bytes = std::uint8_t __attribute__((vector_size(kLanes), aligned(1), may_alias));

// g++ warns that such a value would be returned otherwise with wider vectors; the only function that does is inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

#define STRIAE_LANES(type, pointer) (*reinterpret_cast<type*>(pointer))

}  // namespace

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

STRIAE_VECTORISED void LaneMaximum(const float* in, int length, int reach, float* out, Lanes<float>& scratch) {
  // Position i of the padded line is position i - reach of `in`; out[i] is the largest of the padded i .. i + 2 reach.
  const int window = 2 * reach + 1;
  const int padded = (length + 2 * reach + window - 1) / window * window;
  scratch.resize(At(padded));
  const Floats lowest = Floats{} + std::numeric_limits<float>::lowest();
  const auto value = [&](int i) -> Floats {
    const int from = i - reach;
    return from >= 0 && from < length ? STRIAE_LANES(const Floats, in + At(from)) : lowest;
  };
  Floats falling = lowest;  // largest from a position to the end of its block
  for (int i = padded - 1; i >= 0; --i) {
    if ((i + 1) % window == 0) falling = lowest;
    const Floats own = value(i);
    falling = own > falling ? own : falling;
    STRIAE_LANES(Floats, scratch.data() + At(i)) = falling;
  }
  Floats rising = lowest;  // largest from the start of the block to where the window ends
  for (int i = 0; i < length + window - 1; ++i) {
    if (i % window == 0) rising = lowest;
    const Floats own = value(i);
    rising = own > rising ? own : rising;
    if (i < window - 1) continue;
    const int start = i - (window - 1);
    const Floats begin = STRIAE_LANES(const Floats, scratch.data() + At(start));
    STRIAE_LANES(Floats, out + At(start)) = begin > rising ? begin : rising;
  }
}

namespace {

/// Of every group of positions and the next: sums of light without its background, and of the stripes.
STRIAE_VECTORISED void SumPairs(const float* light, const float* background, const float* stripes, int length,
                                int group, int groups, float* of_light, float* of_stripes) {
  Floats light_before{}, stripes_before{};
  for (int g = groups - 1; g >= 0; --g) {
    Floats x{}, s{};
    for (int i = g * group; i < std::min(length, (g + 1) * group); ++i) {
      x += STRIAE_LANES(const Floats, light + At(i)) - STRIAE_LANES(const Floats, background + At(i));
      s += STRIAE_LANES(const Floats, stripes + At(i));
    }
    STRIAE_LANES(Floats, of_light + At(g)) = x + light_before;
    STRIAE_LANES(Floats, of_stripes + At(g)) = s + stripes_before;
    light_before = x;
    stripes_before = s;
  }
}

/// 255 (1 - r^2)^(1/4) of every lane.
STRIAE_VECTORISED void KeepUnexplained(const float* unexplained, std::uint8_t* misfit) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const float share = std::min(std::max(unexplained[lane], 0.0F), 1.0F);
    misfit[lane] = static_cast<std::uint8_t>(static_cast<int>(255 * std::sqrt(std::sqrt(share))));
  }
}

}  // namespace

STRIAE_VECTORISED void LaneMisfit(const float* light, const float* background, const float* stripes, int length,
                                  int group, Lanes<float>& scratch, std::uint8_t* misfit) {
  constexpr int kReach = 4;  // pairs before the group's middle, and as many after
  const int groups = (length + group - 1) / group;
  scratch.resize(2 * At(groups));
  float *of_light = scratch.data(), *of_stripes = of_light + At(groups);
  SumPairs(light, background, stripes, length, group, groups, of_light, of_stripes);
  for (int g = 0; g < groups; ++g) {
    Floats xx{}, ss{}, xs{};
    for (int k = std::max(0, g - kReach); k < std::min(groups, g + kReach); ++k) {
      const Floats x = STRIAE_LANES(const Floats, of_light + At(k)), s = STRIAE_LANES(const Floats, of_stripes + At(k));
      xx += x * x;
      ss += s * s;
      xs += x * s;
    }
    std::array<float, kLanes> unexplained;
    STRIAE_LANES(Floats, unexplained.data()) = 1.0F - xs * xs / (xx * ss + 1e-30F);
    const int first = g * group;
    KeepUnexplained(unexplained.data(), misfit + At(first));
    for (int i = first + 1; i < std::min(length, first + group); ++i) {
      std::copy_n(misfit + At(first), kLanes, misfit + At(i));
    }
  }
}

STRIAE_VECTORISED void GroupMaximum(const float* in, int length, int group, float* out) {
  for (int first = 0; first < length; first += group) {
    Floats largest = STRIAE_LANES(const Floats, in + At(first));
    for (int i = first + 1; i < std::min(first + group, length); ++i) {
      const Floats value = STRIAE_LANES(const Floats, in + At(i));
      largest = value > largest ? value : largest;
    }
    STRIAE_LANES(Floats, out + At(first / group)) = largest;
  }
}

STRIAE_VECTORISED void JudgeLanes(const float* amplitude, const float* background, const float* maximum, int length,
                                  int group, const MaskLimits& limits, std::uint8_t* mask) {
  for (int first = 0, g = 0; first < length; first += group, ++g) {
    const Floats share = limits.least_share * STRIAE_LANES(const Floats, maximum + At(g));
    const Floats needed = share > limits.least_amplitude ? share : Floats{} + limits.least_amplitude;
    for (int i = first; i < std::min(first + group, length); ++i) {
      const Floats a = STRIAE_LANES(const Floats, amplitude + At(i));
      const Floats b = STRIAE_LANES(const Floats, background + At(i));
      const Ints kept = (a > needed) & (a > limits.least_modulation * b) & (a < limits.most_modulation * b);
      STRIAE_LANES(Bytes, mask + At(i)) = __builtin_convertvector(-kept, Bytes);
    }
  }
}

STRIAE_VECTORISED void DropShortRuns(std::uint8_t* mask, int length, int least, Lanes<std::uint16_t>& scratch) {
  scratch.resize(At(length));
  const auto needed = static_cast<std::uint16_t>(std::clamp(least, 1, 30000));
  Shorts run{};
  for (int i = 0; i < length; ++i) {
    const Shorts valid = -__builtin_convertvector(STRIAE_LANES(const Bytes, mask + At(i)), Shorts);  // all bits or none
    run = (run + static_cast<std::uint16_t>(1)) & valid;
    run = run > static_cast<std::uint16_t>(60000) ? Shorts{} + static_cast<std::uint16_t>(30000) : run;
    STRIAE_LANES(Shorts, scratch.data() + At(i)) = run;
  }
  run = Shorts{};
  for (int i = length - 1; i >= 0; --i) {
    const Shorts here = STRIAE_LANES(const Shorts, scratch.data() + At(i));
    const Shorts valid = -__builtin_convertvector(STRIAE_LANES(const Bytes, mask + At(i)), Shorts);
    run = (here > run ? here : run) & valid;
    STRIAE_LANES(Bytes, mask + At(i)) = __builtin_convertvector((run >= needed) & static_cast<std::uint16_t>(1), Bytes);
  }
}

STRIAE_VECTORISED void TrimRuns(std::uint8_t* mask, int length, int rim, Lanes<std::uint16_t>& scratch) {
  constexpr std::uint16_t kMost = 30000;
  scratch.resize(At(length));
  const Shorts outer = Shorts{} + static_cast<std::uint16_t>(std::clamp(rim, 0, int{kMost} - 1));
  const auto go_on = [](Shorts& run, const std::uint8_t* at) {  // valid pixels in a row so far
    const Shorts valid = -__builtin_convertvector(STRIAE_LANES(const Bytes, at), Shorts);
    run = (run < kMost ? run + static_cast<std::uint16_t>(1) : run) & valid;
  };
  Shorts run = outer;  // what goes on beyond the photograph has no rim there
  for (int i = 0; i < length; ++i) {
    go_on(run, mask + At(i));
    STRIAE_LANES(Shorts, scratch.data() + At(i)) = run;
  }
  run = outer;
  for (int i = length - 1; i >= 0; --i) {
    go_on(run, mask + At(i));
    const Shorts before = STRIAE_LANES(const Shorts, scratch.data() + At(i));
    STRIAE_LANES(Bytes, mask + At(i)) =
        __builtin_convertvector((run > outer) & (before > outer) & static_cast<std::uint16_t>(1), Bytes);
  }
}

}  // namespace striae::reconstruct::detail
