// Adapters of Cairo's PNG and libjpeg; their failures become errors here.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/result.h"

namespace striae::report::detail {

Result<ImageRgb> DecodePng(std::span<const std::uint8_t> bytes);
Result<ImageRgb> DecodeJpeg(std::span<const std::uint8_t> bytes);
Result<std::vector<std::uint8_t>> EncodePng(const ImageRgb& image);
Result<std::vector<std::uint8_t>> EncodeJpeg(const ImageRgb& image, int quality);

}  // namespace striae::report::detail
