// Where a row of an image has values at all: most of a photograph is often background.
#pragma once

#include <cmath>

namespace striae::reconstruct::detail {

/// Pixels [first, last) of a row hold all that are not NaN.
struct Extent {
  int first = 0, last = 0;
  [[nodiscard]] bool empty() const { return first >= last; }
};

inline Extent ExtentOf(const float* row, int width) {
  Extent extent{0, width};
  while (extent.first < width && std::isnan(row[extent.first])) ++extent.first;
  while (extent.last > extent.first && std::isnan(row[extent.last - 1])) --extent.last;
  return extent;
}

}  // namespace striae::reconstruct::detail
