// Pixels in and out of PNG and JPEG bytes, for previews and thumbnails.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/result.h"

namespace striae::report {

/// kBadImage when it is neither a PNG nor a JPEG that can be read, or larger than 100 megapixels.
Result<ImageRgb> DecodePicture(std::span<const std::uint8_t> bytes);

/// 8-bit RGB, no interlace.
Result<std::vector<std::uint8_t>> EncodePng(const ImageRgb& image);
/// Baseline JPEG without metadata; quality 1..100.
Result<std::vector<std::uint8_t>> EncodeJpeg(const ImageRgb& image, int quality);

/// Scaled so that it fits into width x height by averaging whole areas; never enlarged.
ImageRgb ShrinkToFit(const ImageRgb& image, int max_width, int max_height);

}  // namespace striae::report
