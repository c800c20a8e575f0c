// What both forms of the unwrapping agree on: steps between neighbours, and a strict order of the edges.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numbers>

#include "core/image.h"
#include "reconstruct/misfit.h"

namespace striae::reconstruct::detail {

constexpr float kTurn = 2 * std::numbers::pi_v<float>;

/// Whole turns in the difference of two wrapped phases, at most one: -1, 0 or 1. Antisymmetric.
inline int TurnsIn(float difference) {
  constexpr float kHalf = kTurn / 2;
  return static_cast<int>(difference > kHalf) - static_cast<int>(difference < -kHalf);
}

/// Turns to add on the way from a pixel to its neighbour.
inline int StepBetween(float from, float to) { return TurnsIn(from - to); }

/// The pixel grid's edges. An edge is 2 * pixel for the one to the right, 2 * pixel + 1 for the one downwards.
class Edges {
 public:
  /// All must stay; `misfit` may be missing.
  Edges(const ImageF& wrapped, const Mask& mask, const Image<std::uint8_t>* misfit = nullptr)
      : wrapped_(wrapped), mask_(mask), misfit_(misfit) {}

  /// D, the sum of squared second differences in four directions, with the misfit's share; the rim of image and mask is
  /// the least reliable.
  [[nodiscard]] float Unreliability(int x, int row) const {
    constexpr float kLeastReliable = 1e6F;  // above any D: second differences are at most 4 pi
    if (x < 1 || row < 1 || x + 1 >= mask_.width() || row + 1 >= mask_.height()) return kLeastReliable;
    const std::uint8_t *mu = mask_.Row(row - 1) + x, *ma = mask_.Row(row) + x, *md = mask_.Row(row + 1) + x;
    if ((mu[-1] & mu[0] & mu[1] & ma[-1] & ma[0] & ma[1] & md[-1] & md[0] & md[1]) == 0) return kLeastReliable;
    const float *up = wrapped_.Row(row - 1) + x, *at = wrapped_.Row(row) + x, *down = wrapped_.Row(row + 1) + x;
    const auto wrap = [](float d) { return d - kTurn * static_cast<float>(TurnsIn(d)); };
    const auto second = [&](float before, float after) { return wrap(before - at[0]) - wrap(at[0] - after); };
    const float h = second(at[-1], at[1]), v = second(up[0], down[0]);
    const float a = second(up[-1], down[1]), b = second(up[1], down[-1]);
    return h * h + v * v + a * a + b * b + OfMisfit(x, row);
  }

  static constexpr std::uint32_t kKeys = 1U << 22;
  /// A logarithmic key (a float's own upper bits) of an edge's weight, the sum of both pixels' D.
  static std::uint32_t KeyOf(float weight) {
    constexpr std::uint32_t kSmallest = 0x30000000U;  // 4.7e-10: below it, edges are equally perfect
    const auto bits = std::bit_cast<std::uint32_t>(weight);
    return bits < kSmallest ? 0 : std::min(kKeys - 1, (bits - kSmallest) >> 8);
  }

  /// Key and edge in one number: no two edges are equal, so the spanning tree is unique.
  [[nodiscard]] std::uint64_t Right(int x, int row) const {
    return Ranked(Unreliability(x, row) + Unreliability(x + 1, row), 2 * Pixel(x, row));
  }
  [[nodiscard]] std::uint64_t Down(int x, int row) const {
    return Ranked(Unreliability(x, row) + Unreliability(x, row + 1), 2 * Pixel(x, row) + 1);
  }
  [[nodiscard]] bool HasRight(int x, int row) const { return (mask_(x, row) & mask_(x + 1, row)) != 0; }
  [[nodiscard]] bool HasDown(int x, int row) const { return (mask_(x, row) & mask_(x, row + 1)) != 0; }
  [[nodiscard]] const ImageF& wrapped() const { return wrapped_; }
  [[nodiscard]] const Mask& mask() const { return mask_; }
  [[nodiscard]] int width() const { return mask_.width(); }
  [[nodiscard]] int height() const { return mask_.height(); }

 private:
  /// Above the D of any smooth phase wherever the light does not follow its stripes, so that a jump runs there.
  [[nodiscard]] float OfMisfit(int x, int row) const {
    constexpr float kAtMisfitOne = 20;  // rad^2
    if (misfit_ == nullptr) return 0;
    const float misfit = MisfitOf((*misfit_)(x, row));
    return kAtMisfitOne * misfit * misfit;
  }
  [[nodiscard]] std::uint32_t Pixel(int x, int row) const {
    return static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(mask_.width()) + static_cast<std::uint32_t>(x);
  }
  static std::uint64_t Ranked(float weight, std::uint32_t edge) {
    return static_cast<std::uint64_t>(KeyOf(weight)) << 32 | edge;
  }

  const ImageF& wrapped_;
  const Mask& mask_;
  const Image<std::uint8_t>* misfit_;
};

}  // namespace striae::reconstruct::detail
