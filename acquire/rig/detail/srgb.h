// The sRGB curve (IEC 61966-2-1), linear light 0..1 to encoded value 0..1 and back.
#pragma once

#include <cmath>

namespace striae::rig::detail {

inline double ToSrgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

inline float FromSrgb(float encoded) {
  return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

}  // namespace striae::rig::detail
