#include "app/io/phase_preview.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/io/colour_bar.h"
#include "report/drawing.h"
#include "report/picture.h"

namespace striae::app {
namespace {

constexpr Rgb8 kWhite{255, 255, 255}, kInk{38, 50, 58};
constexpr Rgb8 kMeasured{70, 190, 120}, kSaturated{230, 40, 40};

/// Mean of the finite values of each step x step pixels; NaN where there is none.
ImageF Shrunk(const ImageF& image, int step) {
  ImageF out((image.width() + step - 1) / step, (image.height() + step - 1) / step);
  for (int y = 0; y < out.height(); ++y) {
    for (int x = 0; x < out.width(); ++x) {
      float sum = 0;
      int count = 0;
      for (int row = y * step; row < std::min(image.height(), (y + 1) * step); ++row) {
        for (int col = x * step; col < std::min(image.width(), (x + 1) * step); ++col) {
          if (std::isnan(image(col, row))) continue;
          sum += image(col, row);
          ++count;
        }
      }
      out(x, y) = count > 0 ? sum / static_cast<float>(count) : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return out;
}

/// Whole pixels a cell, so that the map is at most `width` x `height`.
int StepFor(int image_width, int image_height, int width, int height) {
  return std::max(
      {1, (image_width + width - 1) / std::max(1, width), (image_height + height - 1) / std::max(1, height)});
}

Result<std::vector<std::uint8_t>> MapPreview(const ImageF& values, const Scale& range, double per_unit,
                                             int max_side_px) {
  const double scale = max_side_px / 320.0;  // letters as in the depth preview
  const int bar_px = static_cast<int>(std::lround(kBarWidth * scale));
  const ImageF cells = Shrunk(values, StepFor(values.width(), values.height(), max_side_px - bar_px, max_side_px));
  const int height = std::max(cells.height(), static_cast<int>(110 * scale));
  ImageRgb picture(cells.width() + bar_px, height, kWhite);
  for (int y = 0; y < cells.height(); ++y) {
    for (int x = 0; x < cells.width(); ++x) {
      if (std::isnan(cells(x, y))) continue;
      picture(x, y) = Viridis((cells(x, y) / per_unit - range.low) / (range.high - range.low));
    }
  }
  Paste(ColourBar(range, height, scale), cells.width(), 0, picture);
  return report::EncodePng(picture);
}

/// A line of coloured squares with their meaning.
ImageRgb Legend(int width_px, double scale) {
  report::Drawing legend;
  legend.width = width_px / scale;
  legend.height = 16;
  const std::pair<const char*, Rgb8> entries[] = {
      {"measured", kMeasured}, {"not measured", Rgb8{70, 70, 70}}, {"saturated", kSaturated}};
  double x = 6;
  for (const auto& [text, colour] : entries) {
    legend.Polygon({{x, 4}, {x + 9, 4}, {x + 9, 13}, {x, 13}}, colour, kInk, 0);
    legend.Text({x + 12, 12}, 9, text, kInk);
    x += 92;
  }
  return report::Rasterise(legend, scale);
}

std::uint8_t Mixed(std::uint8_t a, double share_of_b, std::uint8_t b) {
  return static_cast<std::uint8_t>(std::lround((1 - share_of_b) * a + share_of_b * b));
}

}  // namespace

Result<std::vector<std::uint8_t>> PhasePreview(const reconstruct::PhaseResult& phase, int max_side_px) {
  constexpr double kTwoPi = 2 * std::numbers::pi;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const float value : phase.unwrapped.phase.pixels()) {
    if (std::isnan(value)) continue;
    low = std::min(low, value / kTwoPi);
    high = std::max(high, value / kTwoPi);
  }
  if (!(high >= low)) return Fail(ErrorCode::kMeasurementRefused, "the photograph has no phase to show");
  return MapPreview(phase.unwrapped.phase, {std::floor(low), std::max(std::ceil(high), std::floor(low) + 1), "stripes"},
                    kTwoPi, max_side_px);
}

Result<std::vector<std::uint8_t>> ModulationPreview(const reconstruct::PhaseResult& phase, int max_side_px) {
  ImageF modulation(phase.mask.width(), phase.mask.height());
  for (std::size_t i = 0; i < modulation.size(); ++i) modulation.pixels()[i] = phase.ModulationAt(i);
  return MapPreview(modulation, {0, 1, "modulation"}, 1, max_side_px);
}

Result<std::vector<std::uint8_t>> MaskPreview(const Photograph& photograph, const Mask& mask, int max_side_px) {
  const double scale = max_side_px / 320.0;
  const int step = StepFor(mask.width(), mask.height(), max_side_px, max_side_px - static_cast<int>(16 * scale));
  const int width = (mask.width() + step - 1) / step, height = (mask.height() + step - 1) / step;
  const ImageRgb legend = Legend(std::max(width, static_cast<int>(285 * scale)), scale);
  ImageRgb picture(std::max(width, legend.width()), height + legend.height(), kWhite);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int col = std::min(mask.width() - 1, x * step + step / 2);
      const int row = std::min(mask.height() - 1, y * step + step / 2);
      const Rgb8 c = photograph.colour(col, row);
      const auto grey = static_cast<std::uint8_t>((c.r + c.g + c.b) / 3);
      if (photograph.luminance(col, row) >= photograph.saturation_level) {
        picture(x, y) = kSaturated;
      } else if (mask(col, row) != 0) {
        picture(x, y) = {Mixed(grey, 0.45, kMeasured.r), Mixed(grey, 0.45, kMeasured.g),
                         Mixed(grey, 0.45, kMeasured.b)};
      } else {
        const auto dim = static_cast<std::uint8_t>(grey / 2);
        picture(x, y) = {dim, dim, dim};
      }
    }
  }
  for (int y = 0; y < legend.height(); ++y) std::copy_n(legend.Row(y), legend.width(), picture.Row(height + y));
  return report::EncodePng(picture);
}

}  // namespace striae::app
