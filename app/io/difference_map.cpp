#include "app/io/difference_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "app/io/colour_bar.h"
#include "report/drawing.h"
#include "report/picture.h"

namespace striae::app {
namespace {

constexpr Rgb8 kInk{38, 50, 58}, kEmpty{236, 239, 241};
constexpr int kTitle_px = 20, kGap_px = 8, kBar_px = 90;
constexpr double kScale = 1.4;  // pixels a point of the drawing

/// Blue through white to red (ends of ColorBrewer's RdBu, Brewer and Harrower, Apache 2.0); -1 to 1.
Rgb8 Diverging(double value) {
  const double share = std::clamp(value, -1.0, 1.0);
  const Rgb8 end = share < 0 ? Rgb8{33, 102, 172} : Rgb8{178, 24, 43};
  const auto mix = [&](std::uint8_t to) {
    return static_cast<std::uint8_t>(std::lround(255 + std::abs(share) * (to - 255)));
  };
  return {mix(end.r), mix(end.g), mix(end.b)};
}

/// The 98th percentile of the absolute differences, rounded up to 1, 2 or 5 times a power of ten; 0 without any.
double ScaleOf(const std::vector<DifferencePanel>& panels) {
  std::vector<float> values;
  for (const DifferencePanel& panel : panels) {
    for (const float value : panel.map_mm.pixels()) {
      if (!std::isnan(value)) values.push_back(std::abs(value));
    }
  }
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<long>(0.98 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  const double largest = std::max(1e-4, static_cast<double>(*at));
  const double power = std::pow(10.0, std::floor(std::log10(largest)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= largest) return factor * power;
  }
  return 10 * power;
}

ImageRgb ColourBar(double scale_mm, int height_px) {
  report::Drawing bar;
  bar.width = kBar_px / kScale;
  bar.height = height_px / kScale;
  const double top = 18, bottom = bar.height - 8, left = 6, right = 18;
  constexpr int kSlices = 64;
  for (int i = 0; i < kSlices; ++i) {
    const double y0 = top + (bottom - top) * i / kSlices, y1 = top + (bottom - top) * (i + 1) / kSlices + 0.3;
    bar.Polygon({{left, y0}, {right, y0}, {right, y1}, {left, y1}}, Diverging(1 - 2 * (i + 0.5) / kSlices), kInk, 0);
  }
  for (const double share : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    const double y = top + (bottom - top) * (1 - share) / 2;
    char label[32];
    std::snprintf(label, sizeof label, "%+g", share * scale_mm);
    bar.Line({{right, y}, {right + 3, y}}, 0.7, kInk);
    bar.Text({right + 5, y + 3}, 8, share == 0 ? "0" : label, kInk);
  }
  bar.Text({left, 10}, 8, "mm farther", kInk);
  return report::Rasterise(bar, kScale);
}

ImageRgb Title(const std::string& text, int width_px) {
  report::Drawing title;
  title.width = width_px / kScale;
  title.height = kTitle_px / kScale;
  title.Text({2, title.height - 4}, 8, text, kInk);
  return report::Rasterise(title, kScale);
}

}  // namespace

Result<std::vector<std::uint8_t>> DifferenceMap(const std::vector<DifferencePanel>& panels) {
  const double scale_mm = ScaleOf(panels);
  if (scale_mm == 0) return Fail(ErrorCode::kMeasurementRefused, "there are no differences to draw");
  const int width = panels.front().map_mm.width(), height = panels.front().map_mm.height();
  const int across = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(panels.size()))));
  const int down = (static_cast<int>(panels.size()) + across - 1) / across;
  const int cell_width = width + kGap_px, cell_height = height + kTitle_px + kGap_px;
  ImageRgb picture(across * cell_width + kBar_px, std::max(down * cell_height, 160), Rgb8{255, 255, 255});
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const ImageF& map = panels[i].map_mm;
    if (map.width() != width || map.height() != height) throw std::logic_error("DifferenceMap: sizes differ");
    ImageRgb panel(width, height, kEmpty);
    for (std::size_t p = 0; p < map.size(); ++p) {
      const float value = map.pixels()[p];
      if (!std::isnan(value)) panel.pixels()[p] = Diverging(static_cast<double>(value) / scale_mm);
    }
    const int col = static_cast<int>(i) % across * cell_width, row = static_cast<int>(i) / across * cell_height;
    Paste(Title(panels[i].title, width), col, row, picture);
    Paste(panel, col, row + kTitle_px, picture);
  }
  Paste(ColourBar(scale_mm, picture.height()), across * cell_width, 0, picture);
  return report::EncodePng(picture);
}

}  // namespace striae::app
