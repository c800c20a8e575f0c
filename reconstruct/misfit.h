// How an image keeps misfits, sqrt(1 - r^2) of 0 to 1: a byte each, finest near zero.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace striae::reconstruct {

inline float MisfitOf(std::uint8_t kept) {
  const float root = static_cast<float>(kept) * (1 / 255.0F);
  return root * root;
}

/// The largest byte that keeps no more than `misfit`.
inline std::uint8_t KeptMisfit(double misfit) {
  return static_cast<std::uint8_t>(255 * std::sqrt(std::clamp(misfit, 0.0, 1.0)));
}

}  // namespace striae::reconstruct
