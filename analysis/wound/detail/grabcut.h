// Two classes of cells by OpenCV's GrabCut (the only file that includes it is grabcut.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/result.h"

namespace striae::wound {

enum class CellClass : std::uint8_t { kSkin, kWound, kProbablySkin, kProbablyWound };

/// Three features a cell, row-major, scaled to 0..255; `classes` is what is known and becomes what was found.
/// kMeasurementRefused when one class stays empty; kInternal when OpenCV fails.
Status CutOut(int width, int height, const std::vector<std::array<std::uint8_t, 3>>& features,
              std::vector<CellClass>& classes);

/// sRGB to CIE L*, a*, b*, rounded as OpenCV has them for bytes (a*, b* offset by 128).
std::vector<std::array<std::uint8_t, 3>> ToLab(const std::vector<std::array<std::uint8_t, 3>>& rgb);

/// The longest border line of `inside` (1 = inside), cells as coordinates; holes are passed over.
std::vector<std::array<double, 2>> LongestBorder(int width, int height, const std::vector<std::uint8_t>& inside);

}  // namespace striae::wound
