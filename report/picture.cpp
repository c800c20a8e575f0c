#include "report/picture.h"

#include <algorithm>
#include <cmath>

#include "report/detail/codec.h"

namespace striae::report {
namespace {

/// What of source pixel [i, i + 1) lies in target pixel k of `count`, whose span is [k, k + 1) * scale.
struct Span {
  int first = 0;
  std::vector<float> weights;
};

std::vector<Span> Spans(int source, int target) {
  const double scale = static_cast<double>(source) / target;
  std::vector<Span> spans(static_cast<std::size_t>(target));
  for (int k = 0; k < target; ++k) {
    Span& span = spans[static_cast<std::size_t>(k)];
    const double from = k * scale;
    const double to = std::min((k + 1) * scale, static_cast<double>(source));
    span.first = static_cast<int>(from);
    for (int i = span.first; i < source && i < to; ++i) {
      const double overlap = std::min(to, i + 1.0) - std::max(from, static_cast<double>(i));
      if (overlap > 0) span.weights.push_back(static_cast<float>(overlap / (to - from)));
    }
  }
  return spans;
}

struct RgbF {
  float r = 0, g = 0, b = 0;
};

std::uint8_t ToByte(float value) { return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F))); }

}  // namespace

Result<ImageRgb> DecodePicture(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > 8 && bytes[0] == 0x89 && bytes[1] == 'P') return detail::DecodePng(bytes);
  if (bytes.size() > 3 && bytes[0] == 0xFF && bytes[1] == 0xD8) return detail::DecodeJpeg(bytes);
  return Fail(ErrorCode::kBadImage, "not a PNG or JPEG picture; make the preview again with striae process");
}

Result<std::vector<std::uint8_t>> EncodePng(const ImageRgb& image) {
  if (image.empty()) return Fail(ErrorCode::kBadImage, "an empty picture cannot be written as PNG");
  return detail::EncodePng(image);
}

Result<std::vector<std::uint8_t>> EncodeJpeg(const ImageRgb& image, int quality) {
  if (image.empty()) return Fail(ErrorCode::kBadImage, "an empty picture cannot be written as JPEG");
  return detail::EncodeJpeg(image, quality);
}

ImageRgb ShrinkToFit(const ImageRgb& image, int max_width, int max_height) {
  const double factor = std::min({1.0, static_cast<double>(max_width) / std::max(1, image.width()),
                                  static_cast<double>(max_height) / std::max(1, image.height())});
  if (image.empty() || factor >= 1) return image;
  const int width = std::max(1, static_cast<int>(std::lround(image.width() * factor)));
  const int height = std::max(1, static_cast<int>(std::lround(image.height() * factor)));
  const std::vector<Span> columns = Spans(image.width(), width), rows = Spans(image.height(), height);

  ImageRgb small(width, height);
  std::vector<RgbF> line(static_cast<std::size_t>(width));
  for (int y = 0; y < height; ++y) {
    std::fill(line.begin(), line.end(), RgbF{});
    const Span& vertical = rows[static_cast<std::size_t>(y)];
    for (std::size_t j = 0; j < vertical.weights.size(); ++j) {
      const Rgb8* source = image.Row(vertical.first + static_cast<int>(j));
      for (std::size_t x = 0; x < line.size(); ++x) {
        const Span& horizontal = columns[x];
        for (std::size_t i = 0; i < horizontal.weights.size(); ++i) {
          const Rgb8& pixel = source[horizontal.first + static_cast<int>(i)];
          const float weight = vertical.weights[j] * horizontal.weights[i];
          line[x].r += weight * static_cast<float>(pixel.r);
          line[x].g += weight * static_cast<float>(pixel.g);
          line[x].b += weight * static_cast<float>(pixel.b);
        }
      }
    }
    for (int x = 0; x < width; ++x) {
      const RgbF& mean = line[static_cast<std::size_t>(x)];
      small(x, y) = {ToByte(mean.r), ToByte(mean.g), ToByte(mean.b)};
    }
  }
  return small;
}

}  // namespace striae::report
