// Sixteen lines across the stripes at a time: position by position, so that one vector instruction serves all of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "core/buffer.h"
#include "core/image.h"

namespace striae::reconstruct::detail {

constexpr int kLanes = 16;

/// value[position * kLanes + lane]; a lane is a line.
template <typename T>
using Lanes = Buffer<T>;

/// Copies `width` values of every row; rows lie `from_stride` and `to_stride` values apart.
void CopyRows(const float* from, std::size_t from_stride, int rows, int width, float* to, std::size_t to_stride);

/// Asks for pixels [first, last) of a row that will be read soon: processors foresee steps along memory, but not from
/// row to row.
template <typename T>
void PrefetchRow(const Image<T>& image, int row, int first, int last) {
#if defined(__GNUC__)
  if (row >= image.height()) return;
  constexpr int kPerLine = std::max<int>(1, 64 / sizeof(T));
  for (int x = first; x < last; x += kPerLine) __builtin_prefetch(image.Row(row) + x);
#endif
}

/// Where the lines lie in an image: along columns (horizontal stripes) or along rows.
class LineLayout {
 public:
  LineLayout(int width, int height, bool along_columns)
      : width_(width), height_(height), along_columns_(along_columns) {}
  [[nodiscard]] int lines() const { return along_columns_ ? width_ : height_; }
  [[nodiscard]] int length() const { return along_columns_ ? height_ : width_; }
  /// How many of a block's lanes are lines of their own.
  [[nodiscard]] int LanesOf(int block) const { return Last(block) - block * kLanes; }
  [[nodiscard]] int blocks() const { return (lines() + kLanes - 1) / kLanes; }

  /// Lane l gets the line line_of(l).
  template <typename T, typename LineOf>
  void LoadLines(const Image<T>& image, const LineOf& line_of, T* lanes) const {
    std::array<int, kLanes> line;
    for (int lane = 0; lane < kLanes; ++lane) line[static_cast<std::size_t>(lane)] = line_of(lane);
    for (int position = 0; position < length(); ++position) {
      T* to = lanes + static_cast<std::size_t>(position) * kLanes;
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        to[lane] = along_columns_ ? image(line[lane], position) : image(position, line[lane]);
      }
    }
  }
  /// Sixteen neighbouring lines with `halo` more on either side, position by position: out has length * (kLanes +
  /// 2 halo) values. Beyond the image's border the last line is repeated.
  void LoadWithHalo(const ImageF& image, int block, int halo, float* out) const;
  template <typename T>
  void Store(const T* lanes, int block, Image<T>& image) const {
    const int first = block * kLanes, count = LanesOf(block);
    if constexpr (std::is_same_v<T, float>) {
      if (along_columns_) {
        CopyRows(lanes, kLanes, length(), count, image.Row(0) + first, static_cast<std::size_t>(width_));
        return;
      }
    }
    for (int position = 0; position < length(); ++position) {
      const T* from = lanes + static_cast<std::size_t>(position) * kLanes;
      for (int lane = 0; lane < count; ++lane) {
        (along_columns_ ? image(first + lane, position) : image(position, first + lane)) = from[lane];
      }
    }
  }

 private:
  [[nodiscard]] int Last(int block) const { return std::min((block + 1) * kLanes, lines()); }
  int width_, height_;
  bool along_columns_;
};

/// sRGB's decoding (IEC 61966-2-1), in place; a polynomial within 1e-6 of full scale.
void DecodeSrgb(float* values, std::size_t count);

/// How many values are `level` or more, of `lanes` lines behind the first `halo` in LoadWithHalo's order.
std::size_t CountAtLeast(const float* with_halo, int length, int halo, int lanes, float level);

/// Right half of a Gaussian of that standard deviation (pixels), its middle first; the whole adds up to 1. Cut where
/// less than a thousandth of the middle is left.
std::vector<float> GaussianKernel(double sigma_px);
/// Convolves across the lines: lane l from the lines l to l + 2 halo; the kernel has halo + 1 values.
void SmoothAcross(const float* with_halo, int length, const std::vector<float>& kernel, float* lanes);

/// Mean over `period_px` (fractional) around every position; the ends repeat the border value.
void BoxMean(const float* in, float* out, int length, double period_px);

/// Mean of all lanes over every whole group of `group` positions.
std::vector<float> GroupMeans(const float* in, int length, int group);

/// out = a - b, lane by lane: line l goes to out + l * stride.
void SubtractToLines(const float* a, const float* b, int length, float* out, std::size_t stride);
/// Line l, at in + l * stride, goes to lane l.
void LinesToLanes(const float* in, std::size_t stride, int length, float* out);

}  // namespace striae::reconstruct::detail
