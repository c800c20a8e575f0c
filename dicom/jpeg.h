// What DICOM must know about a JPEG file, read from its markers without decoding (ITU-T T.81), and its metadata
// removed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/result.h"

namespace striae::dicom {

struct JpegInfo {
  enum class Colour { kGrey, kYcc };
  int width_px = 0, height_px = 0;  ///< of the stored pixels, before any EXIF Orientation
  Colour colour = Colour::kYcc;
};

/// kBadImage with the reason for anything but a complete 8-bit baseline JPEG that is grey or YCbCr: only that can be a
/// VL Photographic Image in the transfer syntax JPEG Baseline (Process 1) unchanged.
Result<JpegInfo> InspectJpeg(std::span<const std::uint8_t> jpeg);

/// The same file without APPn and COM segments and without anything after its end, so that nothing but pixels remains.
/// APP0 JFIF and APP14 Adobe stay: they say how the components become colours. The entropy-coded data are copied, so
/// the decoded pixels are the same.
Result<std::vector<std::uint8_t>> StripJpegMetadata(std::span<const std::uint8_t> jpeg);

}  // namespace striae::dicom
