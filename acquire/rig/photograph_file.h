// A simulated photograph as bytes: a JPEG tagged as the D90 tags it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/result.h"

namespace striae::rig {

struct CameraTags {
  std::string serial = "3990001";             ///< of the body; invented
  std::string taken = "2026:01:05 10:00:00";  ///< EXIF local time, as a D90 writes it (no time zone)
  std::string subsecond = "00";
  int iso = 400;
  int orientation = 1;  ///< EXIF 1..8; the pixels stay in sensor orientation
};

/// JPEG with EXIF: NIKON CORPORATION, NIKON D90, 1/200 s, f/11, 50 mm, flash fired, the serial number in the MakerNote.
/// The same input gives the same bytes. kUsage for an empty image, a quality outside 1..100 or unreadable tags.
Result<std::vector<std::uint8_t>> EncodeJpeg(const ImageRgb& photograph, const CameraTags& tags, int quality = 92);

}  // namespace striae::rig
