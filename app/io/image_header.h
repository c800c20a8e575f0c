// What a picture's first bytes say, read before anything of its size is reserved.
#pragma once

#include <cstdint>
#include <span>

#include "core/result.h"

namespace striae::app {

enum class ImageKind { kJpeg, kPng, kTiff, kBmp, kRaw };

struct ImageHeader {
  ImageKind kind = ImageKind::kJpeg;
  std::int64_t width = 0, height = 0;  ///< 0 where only decoding tells (raw files: LibRaw reads them)
};

/// The most pixels that are decoded: eight times the D90's. More is refused before memory is reserved for it.
inline constexpr std::int64_t kMostPixels = 100'000'000;

/// By content, never by the file's name. A TIFF with a colour filter array (NEF, DNG) is kRaw. kBadImage for any other
/// kind of file, a header that is cut short, no pixels at all, or more than kMostPixels.
Result<ImageHeader> ReadImageHeader(std::span<const std::uint8_t> bytes);

}  // namespace striae::app
