// Lines across the stripes, whichever way these run.
#pragma once

#include <algorithm>
#include <numbers>
#include <vector>

#include "reconstruct/phase.h"

namespace striae::reconstruct::detail {

/// The middle of the values (the upper one of two), which are put into another order. Not of none.
template <typename T>
T MedianOf(std::vector<T>& values) {
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// (line, position) is (col, row) for horizontal stripes and (row, col) for vertical ones.
class Lines {
 public:
  explicit Lines(const PhaseResult& phase)
      : phase_(phase), horizontal_(phase.direction == StripeDirection::kHorizontal) {}
  [[nodiscard]] int count() const { return horizontal_ ? phase_.mask.width() : phase_.mask.height(); }
  [[nodiscard]] int length() const { return horizontal_ ? phase_.mask.height() : phase_.mask.width(); }
  [[nodiscard]] bool Has(int position) const { return position >= 0 && position < length(); }
  /// Every how many lines one is looked at: about a thousand over the picture.
  [[nodiscard]] int Step() const { return std::max(1, count() / 1000); }
  template <typename T>
  [[nodiscard]] T At(const Image<T>& image, int line, int position) const {
    return horizontal_ ? image(line, position) : image(position, line);
  }
  [[nodiscard]] int Region(int line, int position) const { return At(phase_.unwrapped.region, line, position); }
  /// Relative order, stripes; NaN outside of the regions.
  [[nodiscard]] double Order(int line, int position) const {
    return At(phase_.unwrapped.phase, line, position) / (2 * std::numbers::pi);
  }

  /// Calls visit(line, position, region) for the pixels of every Step()-th line that belong to one of the first
  /// `regions` regions; the positions of a line come in ascending order, memory is read row by row.
  template <typename Visit>
  void ForEachPixel(int regions, const Visit& visit) const {
    const auto& region = phase_.unwrapped.region;
    const int step = Step(), col_step = horizontal_ ? step : 1, row_step = horizontal_ ? 1 : step;
    for (int row = 0; row < region.height(); row += row_step) {
      const std::int32_t* r = region.Row(row);
      for (int col = 0; col < region.width(); col += col_step) {
        if (r[col] >= 0 && r[col] < regions) visit(horizontal_ ? col : row, horizontal_ ? row : col, r[col]);
      }
    }
  }

 private:
  const PhaseResult& phase_;
  bool horizontal_;
};

}  // namespace striae::reconstruct::detail
