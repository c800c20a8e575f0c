// Encoding of images that are measurements, not pictures.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/result.h"

namespace striae::app {

/// TIFF with one 32-bit float channel, NaN kept.
Result<std::vector<std::uint8_t>> EncodeFloatTiff(const ImageF& image);
/// PNG, 8 bit grey: 255 where the mask is valid, else 0.
Result<std::vector<std::uint8_t>> EncodeMaskPng(const Mask& mask);

}  // namespace striae::app
