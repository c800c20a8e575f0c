#include "reconstruct/detail/extent.h"

#include <cmath>

#include "core/vector.h"

namespace striae::reconstruct::detail {

STRIAE_VECTORISED Extent ExtentOf(const float* row, int width) {
  constexpr int kBlock = 64;
  const auto empty = [](const float* block) {
    int values = 0;
    for (int k = 0; k < kBlock; ++k) values += block[k] == block[k] ? 1 : 0;
    return values == 0;
  };
  Extent extent{0, width};
  while (extent.first + kBlock <= width && empty(row + extent.first)) extent.first += kBlock;
  while (extent.first < width && std::isnan(row[extent.first])) ++extent.first;
  while (extent.last - kBlock >= extent.first && empty(row + extent.last - kBlock)) extent.last -= kBlock;
  while (extent.last > extent.first && std::isnan(row[extent.last - 1])) --extent.last;
  return extent;
}

}  // namespace striae::reconstruct::detail
