// Small, true photographs without an encoder: a flat grey baseline JPEG of any size with EXIF as asked, and a NEF-like
// TIFF. The bytes are written here from the formats' definitions, so that they test a reader of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace striae::testing {

struct PhotoOptions {
  int width = 4288, height = 2848;
  bool with_exif = true;
  std::string make = "NIKON CORPORATION", model = "NIKON D90", lens = "AF NIKKOR 50mm f/1.8D";
  std::uint32_t exposure_num = 10, exposure_den = 2000;
  std::uint32_t f_number_tenths = 110, focal_length_tenths = 500;
  int iso = 400;
  int flash = 0x0F;  ///< EXIF: bit 0 = fired
  int orientation = 1;
  std::string taken = "2026:05:04 07:08:09", sub_second = "12";
  std::size_t padding = 0;  ///< about so many bytes more, in comment segments
};

std::vector<std::uint8_t> MakeJpeg(const PhotoOptions& options = {});
/// As a D90 writes it: IFD0 with a small preview and two SubIFDs, JPEG preview and one strip of raw data.
std::vector<std::uint8_t> MakeNef(const PhotoOptions& options = {}, std::size_t raw_bytes = 4096);

}  // namespace striae::testing
