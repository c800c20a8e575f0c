// Pseudo-random numbers that are the same on every machine, compiler and number of threads.
#pragma once

#include <cstdint>

namespace striae::rig::detail {

/// SplitMix64 (Steele, Lea, Flood 2014): whatever is worked on separately starts its own sequence, so threads do not
/// matter.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t Next() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15U;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
  }
  /// Standard normal to good approximation: the sum of eight 16-bit uniforms, no library function involved.
  float Normal() {
    std::uint32_t sum = 0;
    for (int word = 0; word < 2; ++word) {
      for (std::uint64_t bits = Next(), i = 0; i < 4; ++i, bits >>= 16U)
        sum += static_cast<std::uint32_t>(bits & 0xFFFFU);
    }
    constexpr float kMean = 8 * 65535.0F / 2, kSd = 53509.4F;  // sqrt(8 (65536^2 - 1) / 12)
    return (static_cast<float>(sum) - kMean) / kSd;
  }
  /// Uniform from `low` to below `high`.
  double Uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(Next() >> 11U) * 0x1.0p-53);
  }

 private:
  std::uint64_t state_;
};

}  // namespace striae::rig::detail
