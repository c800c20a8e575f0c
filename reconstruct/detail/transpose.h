// Turns an image so that what ran down a column runs along a row.
#pragma once

#include <type_traits>

#include "core/image.h"
#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {

/// With every pixel passed through `map`.
template <typename T, typename Map>
auto TransposedThrough(const Image<T>& from, const Map& map) {
  constexpr int kTile = 32;  // a tile of both images fits the first-level cache
  using Out = std::decay_t<decltype(map(from(0, 0)))>;
  Image<Out> to(from.height(), from.width());
  ParallelBlocks(
      from.width(),
      [&](int, int first, int last) {
        for (int top = 0; top < from.height(); top += kTile) {
          const int bottom = std::min(from.height(), top + kTile);
          for (int col = first; col < last; ++col) {
            Out* out = to.Row(col);
            for (int row = top; row < bottom; ++row) out[row] = map(from(col, row));
          }
        }
      },
      kTile);
  return to;
}

template <typename T>
Image<T> Transposed(const Image<T>& from) {
  return TransposedThrough(from, [](const T& pixel) { return pixel; });
}

}  // namespace striae::reconstruct::detail
