// JPEG -> photograph. libjpeg-turbo directly: OpenCV and others go on with grey where a file ends early.
#pragma once

#include <cstdint>
#include <span>

#include "core/image.h"
#include "core/result.h"

namespace striae::app {

/// 8-bit grey or YCbCr; the pixels as the sensor has them. kBadImage for every irregularity, libjpeg's warnings too.
/// The caller has bounded the size (ReadImageHeader).
Result<Photograph> DecodeJpeg(std::span<const std::uint8_t> bytes);

}  // namespace striae::app
