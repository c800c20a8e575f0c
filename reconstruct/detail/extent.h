// Where a row of an image has values at all: most of a photograph is often background.
#pragma once

namespace striae::reconstruct::detail {

/// Pixels [first, last) of a row hold all that are not NaN.
struct Extent {
  int first = 0, last = 0;
  [[nodiscard]] bool empty() const { return first >= last; }
};

Extent ExtentOf(const float* row, int width);

}  // namespace striae::reconstruct::detail
