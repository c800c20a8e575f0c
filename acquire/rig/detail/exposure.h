// From linear light on the sensor to the 8-bit sRGB picture: lens blur, noise, saturation, encoding.
#pragma once

#include <array>

#include "acquire/rig/render.h"

namespace striae::rig::detail {

using LinearRgb = std::array<float, 3>;  ///< 1 saturates

/// The lens' image of a point: a Gaussian that stands for its errors and for the disc of defocus.
struct LensBlur {
  double in_focus_px = 0;  ///< standard deviation
  double aperture_fx = 0;  ///< pupil in mm times fx in px: the disc is aperture_fx |1/z - 1/focus_mm| px wide
  double focus_mm = 1000;
};

/// `depth_mm` says how far out of focus a pixel is; where it is NaN the blur is that of focus. `pixel_area` is the area
/// of a pixel over a full D90 pixel's (binning collects more electrons).
ImageRgb Expose(const Image<LinearRgb>& light, const ImageF& depth_mm, const SensorOptions& options,
                const LensBlur& blur, double pixel_area, int threads);

}  // namespace striae::rig::detail
