// Colours for numbers, and the bar that says which.
#pragma once

#include <string>

#include "core/image.h"

namespace striae::app {

/// Viridis: 0 = dark blue, 1 = bright yellow; beyond, the end colours.
Rgb8 Viridis(double share);

struct Scale {
  double low = 0, high = 1;    ///< ends of the bar; high > low
  std::string unit;            ///< written above it
  bool low_is_bright = false;  ///< the bright end, at the top, stands for `low` (depth: near)
};

constexpr double kBarWidth = 62;  ///< points, labels included

/// The bar with its labels, `scale` pixels a point.
ImageRgb ColourBar(const Scale& values, int height_px, double scale);

/// Lays `part` into `whole` from column `col` and row `row` on, what fits.
void Paste(const ImageRgb& part, int col, int row, ImageRgb& whole);

}  // namespace striae::app
