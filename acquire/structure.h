// Is a file a whole photograph? A truncated JPEG decodes without complaint in many programs, so this is asked first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/result.h"

namespace striae::acquire {

/// What a file's own skeleton says, without decoding a pixel.
struct FileStructure {
  std::string media_type;  ///< "image/jpeg" or "image/x-nikon-nef"
  int width_px = 0;        ///< of the main image as stored, before any Orientation
  int height_px = 0;
  std::size_t image_bytes = 0;     ///< up to and with the last byte that the image needs
  std::size_t trailing_bytes = 0;  ///< after that; some cards and tools pad files
};

/// JPEG: SOI, every segment inside the file, a frame with a size, at least one scan with data, EOI.
/// NEF: TIFF of either byte order made by Nikon, every directory inside the file, every strip and preview it points
/// to inside the file.
/// Anything else is kBadImage: not a photograph, truncated (says after how many bytes), or contradictory. Never
/// throws and reads only inside `bytes`, whatever they are.
Result<FileStructure> CheckStructure(std::span<const std::uint8_t> bytes);

}  // namespace striae::acquire
