// Decoding photographs, in sensor orientation: EXIF Orientation turns a picture for a viewer and is never applied.
#pragma once

#include <cstdint>
#include <span>

#include "core/image.h"
#include "core/result.h"

namespace striae::app {

/// JPEG (8 bit), PNG, TIFF, BMP (8 or 16 bit), grey or colour; NEF and DNG (linear light, see raw.h). kBadImage for
/// what is no image, truncated (a JPEG that ends early is an error, never a grey rest), or larger than 100 megapixels,
/// which is seen before memory is reserved.
Result<Photograph> DecodePhotograph(std::span<const std::uint8_t> bytes);

}  // namespace striae::app
