// A raw file made by hand, so that the real raw decoder runs where no camera's file may be kept.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace striae::testing {

struct DngOptions {
  int width = 0, height = 0;  ///< of the sensor, even
  std::uint16_t white = 16383;
  std::string make = "Test", model = "Bayer";
  std::vector<std::uint8_t> preview_jpeg;  ///< embedded as the camera's JPEG when not empty
  int preview_width = 0, preview_height = 0;
};

/// An uncompressed DNG, RGGB; `value(col, row, channel)` is the sensor's value (0 red, 1 green, 2 blue).
std::vector<std::uint8_t> MakeDng(const DngOptions& options, const std::function<std::uint16_t(int, int, int)>& value);

}  // namespace striae::testing
