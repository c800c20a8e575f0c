// Lines across the stripes, whichever way these run.
#pragma once

#include <algorithm>
#include <numbers>
#include <vector>

#include "reconstruct/detail/parallel.h"
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

  /// Calls visit(line, position, region) for every `stride`-th pixel of every Step()-th line that belongs to one of the
  /// first `regions` regions; the positions of a line come in ascending order and from one thread, different lines from
  /// several.
  template <typename Visit>
  void ForEachPixel(int regions, int stride, const Visit& visit) const {
    constexpr int kTogether = 64;  // lines: memory is read row by row
    const auto& region = phase_.unwrapped.region;
    const int step = Step();
    ParallelBlocks((count() + step - 1) / step,
                   [&](int, int first, int last) {
                     const int from = first * step, to = std::min(count(), last * step);
                     const int row_first = horizontal_ ? 0 : from, row_last = horizontal_ ? region.height() : to;
                     const int col_first = horizontal_ ? from : 0, col_last = horizontal_ ? to : region.width();
                     for (int row = row_first; row < row_last; row += horizontal_ ? stride : step) {
                       const std::int32_t* r = region.Row(row);
                       for (int col = col_first; col < col_last; col += horizontal_ ? step : stride) {
                         if (r[col] >= 0 && r[col] < regions)
                           visit(horizontal_ ? col : row, horizontal_ ? row : col, r[col]);
                       }
                     }
                   },
                   kTogether);
  }

 private:
  const PhaseResult& phase_;
  bool horizontal_;
};

}  // namespace striae::reconstruct::detail
