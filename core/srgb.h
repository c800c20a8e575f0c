// The sRGB curve (IEC 61966-2-1): linear light 0..1 to encoded value 0..1 and back.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace striae {

inline double SrgbFromLight(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

inline double LightFromSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// Light of every 8-bit value.
inline std::array<double, 256> LightOfBytes() {
  std::array<double, 256> light{};
  for (std::size_t i = 0; i < light.size(); ++i) light[i] = LightFromSrgb(static_cast<double>(i) / 255);
  return light;
}

}  // namespace striae
