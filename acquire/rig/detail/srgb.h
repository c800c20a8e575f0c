// The sRGB curve in single precision, as meshes hold their colours (core/srgb.h has it in double).
#pragma once

#include <cmath>

namespace striae::rig::detail {

inline float FromSrgb(float encoded) {
  return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

}  // namespace striae::rig::detail
