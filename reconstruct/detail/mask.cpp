#include "reconstruct/detail/mask.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>
#include <vector>

#include "core/vector.h"
#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {
namespace {

/// The three pixels above each other: all of them, or any.
STRIAE_VECTORISED void CombineRows(const std::uint8_t* up, const std::uint8_t* at, const std::uint8_t* down, int width,
                                   bool all, std::uint8_t* out) {
  if (all) {
    for (int x = 0; x < width; ++x) out[x] = up[x] & at[x] & down[x];
  } else {
    for (int x = 0; x < width; ++x) out[x] = up[x] | at[x] | down[x];
  }
}

/// 3 x 3 erosion (all) or dilation; the image's border repeats.
Mask Morphed(const Mask& mask, bool all) {
  const int width = mask.width(), height = mask.height();
  Mask out = Mask::Unset(width, height);
  ParallelBlocks(height, [&](int, int begin, int end) {
    std::vector<std::uint8_t> column(static_cast<std::size_t>(width) + 2);  // of three; one more at either end
    for (int row = begin; row < end; ++row) {
      CombineRows(mask.Row(std::max(0, row - 1)), mask.Row(row), mask.Row(std::min(height - 1, row + 1)), width, all,
                  column.data() + 1);
      column.front() = column[1];
      column.back() = column[column.size() - 2];
      CombineRows(column.data(), column.data() + 1, column.data() + 2, width, all, out.Row(row));
    }
  });
  return out;
}

STRIAE_VECTORISED void CutStepsOfRow(const float* up, const float* at, const float* down, int width, float largest,
                                     std::uint8_t* mask) {
  constexpr float kTurn = 2 * std::numbers::pi_v<float>;
  const auto wrap = [](float d) {  // |d| < 2 pi: both phases are wrapped
    d = d > kTurn / 2 ? d - kTurn : d;
    return d < -kTurn / 2 ? d + kTurn : d;
  };
  for (int x = 1; x + 1 < width; ++x) {
    const float h = wrap(at[x - 1] - at[x]) - wrap(at[x] - at[x + 1]);
    const float v = wrap(up[x] - at[x]) - wrap(at[x] - down[x]);
    const bool smooth = (std::abs(h) <= largest) & (std::abs(v) <= largest);
    mask[x] = smooth ? mask[x] : std::uint8_t{0};
  }
}

struct Run {
  int first, last;  ///< pixels [first, last) of a row
};

const std::uint8_t* Find(const std::uint8_t* begin, const std::uint8_t* end, int value) {
  const void* found = std::memchr(begin, value, static_cast<std::size_t>(end - begin));
  return found != nullptr ? static_cast<const std::uint8_t*>(found) : end;
}

std::vector<std::vector<Run>> RunsOf(const Mask& mask) {
  std::vector<std::vector<Run>> runs(static_cast<std::size_t>(mask.height()));
  ParallelLines(mask.height(), [&](int row) {
    const std::uint8_t *begin = mask.Row(row), *end = begin + mask.width();
    for (const std::uint8_t* at = begin; at != end;) {
      at = Find(at, end, 1);
      const std::uint8_t* stop = Find(at, end, 0);
      if (at != stop)
        runs[static_cast<std::size_t>(row)].push_back({static_cast<int>(at - begin), static_cast<int>(stop - begin)});
      at = stop;
    }
  });
  return runs;
}

/// Pixels of connected runs: union-find whose roots hold minus their number of pixels.
class RunGroups {
 public:
  std::size_t Add(int pixels) {
    parent_.push_back(-pixels);
    return parent_.size() - 1;
  }
  void Unite(std::size_t a, std::size_t b) {
    a = Root(a);
    b = Root(b);
    if (a == b) return;
    if (parent_[b] < parent_[a]) std::swap(a, b);
    parent_[a] += parent_[b];
    parent_[b] = static_cast<int>(a);
  }
  [[nodiscard]] int Pixels(std::size_t run) { return -parent_[Root(run)]; }

 private:
  std::size_t Root(std::size_t run) {
    while (parent_[run] >= 0) {
      const auto up = static_cast<std::size_t>(parent_[run]);
      if (parent_[up] >= 0) parent_[run] = parent_[up];
      run = up;
    }
    return run;
  }
  std::vector<int> parent_;
};

void DropSpecks(Mask& mask, int least_px) {
  const auto runs = RunsOf(mask);
  RunGroups groups;
  std::size_t above = 0;  // number of the first run of the row above
  for (std::size_t row = 0; row < runs.size(); ++row) {
    std::size_t here = 0;
    for (std::size_t i = 0; i < runs[row].size(); ++i) {
      const std::size_t added = groups.Add(runs[row][i].last - runs[row][i].first);
      if (i == 0) here = added;
    }
    if (row > 0 && !runs[row].empty()) {
      const auto &up = runs[row - 1], &at = runs[row];
      for (std::size_t a = 0, b = 0; a < up.size() && b < at.size();) {
        if (std::max(up[a].first, at[b].first) < std::min(up[a].last, at[b].last)) groups.Unite(above + a, here + b);
        up[a].last < at[b].last ? ++a : ++b;
      }
    }
    above = here;
  }
  std::size_t run = 0;
  for (std::size_t row = 0; row < runs.size(); ++row) {
    std::uint8_t* m = mask.Row(static_cast<int>(row));
    for (const auto& [first, last] : runs[row]) {
      if (groups.Pixels(run++) < least_px) std::fill(m + first, m + last, std::uint8_t{0});
    }
  }
}

}  // namespace

void CleanMask(Mask& mask, int least_px) {
  mask = Morphed(Morphed(mask, true), false);
  DropSpecks(mask, least_px);
}

void CutSteps(const ImageF& wrapped, Mask& mask, float largest) {
  ParallelLines(wrapped.height(), [&](int row) {
    if (row == 0 || row == wrapped.height() - 1) return;
    CutStepsOfRow(wrapped.Row(row - 1), wrapped.Row(row), wrapped.Row(row + 1), wrapped.width(), largest,
                  mask.Row(row));
  });
}

}  // namespace striae::reconstruct::detail
