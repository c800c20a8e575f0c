// One grey value of a colour pixel.
#pragma once

namespace striae::app {

/// Rec. 709 weights on the values as they are: close to what the flash and skin give, and never above full scale.
inline float Luminance(float r, float g, float b) { return 0.2126F * r + 0.7152F * g + 0.0722F * b; }

/// Luminance from which an 8-bit picture counts as saturated: one step below full scale.
inline constexpr float kSaturated8 = 254.0F / 255;

}  // namespace striae::app
