// From linear light on the sensor to the 8-bit sRGB picture: lens blur, noise, saturation, encoding.
#pragma once

#include <array>

#include "acquire/rig/render.h"

namespace striae::rig::detail {

using LinearRgb = std::array<float, 3>;  ///< 1 saturates

/// `pixel_area` is the area of a pixel over a full D90 pixel's (binning collects more electrons).
ImageRgb Expose(const Image<LinearRgb>& light, const SensorOptions& options, double blur_px, double pixel_area,
                int threads);

}  // namespace striae::rig::detail
