#include "app/io/colour_bar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "report/drawing.h"

namespace striae::app {
namespace {

constexpr Rgb8 kInk{38, 50, 58};

/// Viridis (van der Walt and Smith, matplotlib, CC0) at eleven places; straight lines between them.
constexpr std::array<Rgb8, 11> kViridis = {{{68, 1, 84},
                                            {72, 36, 117},
                                            {65, 68, 135},
                                            {53, 95, 141},
                                            {42, 120, 142},
                                            {33, 145, 140},
                                            {34, 168, 132},
                                            {68, 191, 112},
                                            {122, 209, 81},
                                            {189, 223, 38},
                                            {253, 231, 37}}};

/// 1, 2 or 5 times a power of ten: about five labels on the bar.
double TickStep(double span_mm) {
  const double power = std::pow(10.0, std::floor(std::log10(span_mm / 5)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= span_mm / 5) return factor * power;
  }
  return 10 * power;
}

}  // namespace

Rgb8 Viridis(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (kViridis.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), kViridis.size() - 2);
  const double rest = at - static_cast<double>(low);
  const auto mix = [&](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + rest * (b - a)));
  };
  return {mix(kViridis[low].r, kViridis[low + 1].r), mix(kViridis[low].g, kViridis[low + 1].g),
          mix(kViridis[low].b, kViridis[low + 1].b)};
}

ImageRgb ColourBar(const Scale& values, int height_px, double scale) {
  report::Drawing bar;
  bar.width = kBarWidth;
  bar.height = height_px / scale;
  const double top = 16, bottom = bar.height - 8, left = 8, right = 20;
  constexpr int kSlices = 64;
  for (int i = 0; i < kSlices; ++i) {
    const double y0 = top + (bottom - top) * i / kSlices, y1 = top + (bottom - top) * (i + 1) / kSlices + 0.3;
    bar.Polygon({{left, y0}, {right, y0}, {right, y1}, {left, y1}}, Viridis(1 - (i + 0.5) / kSlices), kInk, 0);
  }
  const double step = TickStep(values.high - values.low);
  const int decimals = step < 1 ? static_cast<int>(std::ceil(-std::log10(step) - 1e-9)) : 0;
  const double first = std::ceil(values.low / step - 1e-9) * step;
  for (double value = first; value <= values.high + 1e-9 * step; value += step) {
    const double share = (value - values.low) / (values.high - values.low);
    const double y = top + (bottom - top) * (values.low_is_bright ? share : 1 - share);
    char label[32];
    std::snprintf(label, sizeof label, "%.*f", decimals, value + 0.0);
    bar.Line({{right, y}, {right + 3, y}}, 0.7, kInk);
    bar.Text({right + 5, y + 3}, 9, label, kInk);
  }
  bar.Text({left, 9}, 9, values.unit, kInk);
  return report::Rasterise(bar, scale);
}

void Paste(const ImageRgb& part, int col, int row, ImageRgb& whole) {
  for (int y = 0; y < std::min(part.height(), whole.height() - row); ++y) {
    std::copy_n(part.Row(y), std::min(part.width(), whole.width() - col), whole.Row(row + y) + col);
  }
}

}  // namespace striae::app
