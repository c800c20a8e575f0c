#include "reconstruct/detail/lane_mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/vector.h"
#include "reconstruct/detail/lane_types.h"

namespace striae::reconstruct::detail {

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
  constexpr int kReach = 6;  // pairs before the group's middle, and as many after
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
