// Pixel grids. (col, row) = (x, y); integer coordinates are pixel centres; row-major, no padding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "core/buffer.h"

namespace striae {

struct Rgb8 {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Rgb8&) const = default;
};

template <typename T>
class Image {
 public:
  Image() = default;
  Image(int width, int height, T fill = T{}) : width_(width), height_(height), pixels_(Count(width, height), fill) {}
  /// Pixels that the caller writes before anything reads them.
  static Image Unset(int width, int height) {
    Image image;
    image.width_ = width;
    image.height_ = height;
    image.pixels_ = Buffer<T>(Count(width, height));
    return image;
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] std::size_t size() const { return pixels_.size(); }
  [[nodiscard]] bool empty() const { return pixels_.empty(); }
  [[nodiscard]] bool Contains(int col, int row) const { return col >= 0 && row >= 0 && col < width_ && row < height_; }

  T& operator()(int col, int row) { return pixels_[Index(col, row)]; }
  const T& operator()(int col, int row) const { return pixels_[Index(col, row)]; }
  T* Row(int row) { return pixels_.data() + Index(0, row); }
  const T* Row(int row) const { return pixels_.data() + Index(0, row); }
  [[nodiscard]] Buffer<T>& pixels() { return pixels_; }
  [[nodiscard]] const Buffer<T>& pixels() const { return pixels_; }

 private:
  static std::size_t Count(int width, int height) {
    if (width < 0 || height < 0) throw std::logic_error("Image: negative size");
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  [[nodiscard]] std::size_t Index(int col, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(col);
  }

  int width_ = 0, height_ = 0;
  Buffer<T> pixels_;
};

using ImageF = Image<float>;
using Mask = Image<std::uint8_t>;  ///< 0 = invalid, 1 = valid
using ImageRgb = Image<Rgb8>;

/// A decoded photograph, in sensor orientation (EXIF Orientation is never applied).
struct Photograph {
  ImageF luminance;               ///< 0..1 as encoded (sRGB not linearised) unless `linear`
  ImageRgb colour;                ///< 8 bit, sRGB; grey inputs have r = g = b
  float saturation_level = 1.0F;  ///< luminance at and above which a pixel carries no information
  bool linear = false;            ///< luminance is proportional to light already (raw files)
};

}  // namespace striae
