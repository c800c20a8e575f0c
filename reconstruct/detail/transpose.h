// Turns an image so that what ran down a column runs along a row.
#pragma once

#include "core/image.h"
#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {

template <typename T>
Image<T> Transposed(const Image<T>& from) {
  constexpr int kTile = 32;  // a tile of both images fits the first-level cache
  Image<T> to(from.height(), from.width());
  ParallelBlocks(
      from.width(),
      [&](int, int first, int last) {
        for (int top = 0; top < from.height(); top += kTile) {
          const int bottom = std::min(from.height(), top + kTile);
          for (int col = first; col < last; ++col) {
            T* out = to.Row(col);
            for (int row = top; row < bottom; ++row) out[row] = from(col, row);
          }
        }
      },
      kTile);
  return to;
}

}  // namespace striae::reconstruct::detail
