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
  double focus_mm = 1000;  ///< the lens' scale, in the MakerNote's encrypted lens data; steps of 6 % as Nikon codes it
  int shutter_count = 4711;  ///< part of the key of that encryption
  int orientation = 1;       ///< EXIF 1..8; the pixels stay in sensor orientation
};

/// JPEG with EXIF: NIKON CORPORATION, NIKON D90, 1/200 s, f/11, 50 mm, flash fired; in the MakerNote
/// serial number, shutter count, focus distance and what else identifies such a photograph.
/// The same input gives the same bytes. kUsage for an empty image, a quality outside 1..100 or unreadable tags.
Result<std::vector<std::uint8_t>> EncodeJpeg(const ImageRgb& photograph, const CameraTags& tags, int quality = 92);

}  // namespace striae::rig
