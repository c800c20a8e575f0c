#include <algorithm>
#include <limits>
#include <utility>

#include "reconstruct/detail/parallel.h"
#include "reconstruct/detail/unwrap_edges.h"
#include "reconstruct/detail/unwrap_forms.h"
#include "reconstruct/detail/unwrap_sheets.h"

namespace striae::reconstruct::detail {
namespace {

/// Pixels [first, last) of a row without a step between them.
struct Segment {
  int first, last;
  std::int32_t turns;  ///< relative to its piece
  std::int32_t piece;  ///< pixels of a row that hang together without a cut; counted within the row
  std::int32_t region = 0;
};
using Segments = std::vector<Segment>;

/// Columns of one kind of cut edges in one row, ascending.
using Cuts = std::vector<int>;

Segments SegmentsOf(const float* phase, const std::uint8_t* mask, int width, const Cuts& right_cuts) {
  Segments segments;
  std::int32_t piece = 0;
  auto cut = right_cuts.begin();
  for (int x = 0; x < width; ++x) {
    if (mask[x] == 0) continue;
    std::int32_t turns = 0;
    int first = x;
    for (; x + 1 < width && mask[x + 1] != 0; ++x) {
      const int step = StepBetween(phase[x], phase[x + 1]);
      while (cut != right_cuts.end() && *cut < x) ++cut;
      const bool parted = cut != right_cuts.end() && *cut == x;
      if (step == 0 && !parted) continue;
      segments.push_back({first, x + 1, turns, piece});
      first = x + 1;
      turns += step;
      piece += parted ? 1 : 0;
    }
    segments.push_back({first, x + 1, turns, piece++});
  }
  return segments;
}

/// The rows' segments and the pieces' places relative to each other.
class Rows {
 public:
  Rows(const ImageF& wrapped, const Mask& mask, const std::vector<std::uint32_t>& cuts)
      : wrapped_(wrapped), segments_(static_cast<std::size_t>(mask.height())), down_cuts_(segments_.size()) {
    std::vector<Cuts> right_cuts(segments_.size());
    for (const std::uint32_t edge : cuts) {
      const std::uint32_t pixel = edge / 2, width = static_cast<std::uint32_t>(mask.width());
      ((edge & 1U) != 0 ? down_cuts_ : right_cuts)[pixel / width].push_back(static_cast<int>(pixel % width));
    }
    ParallelLines(mask.height(), [&](int row) {
      segments_[static_cast<std::size_t>(row)] =
          SegmentsOf(wrapped.Row(row), mask.Row(row), mask.width(), right_cuts[static_cast<std::size_t>(row)]);
    });
    std::int32_t pieces = 0;
    for (Segments& row : segments_) {
      const std::int32_t before = pieces;
      for (Segment& segment : row) pieces = std::max(pieces, (segment.piece += before) + 1);
    }
    sheets_ = Sheets(static_cast<std::size_t>(pieces));
    for (std::size_t row = 1; row < segments_.size(); ++row) JoinToAbove(static_cast<int>(row));
  }

  /// Segments get their region and the turns relative to its first pixel; returns the pixels of every region.
  std::vector<std::size_t> Settle() {
    std::vector<RegionFound> found;
    std::vector<std::int32_t> number(sheets_.size(), -1);  // of a root, in the order of appearance
    for (Segments& row : segments_) {
      for (Segment& segment : row) {
        const auto place = sheets_.Find(segment.piece);
        auto& known = number[static_cast<std::size_t>(place.root)];
        segment.turns += place.turns;
        if (known < 0) {
          known = static_cast<std::int32_t>(found.size());
          found.push_back({0, segment.turns});
        }
        RegionFound& region = found[static_cast<std::size_t>(known)];
        region.pixels += segment.last - segment.first;
        segment.turns -= region.first_turns;
        segment.region = known;
      }
    }
    const std::vector<std::int32_t> rank = RankBySize(found);
    for (Segments& row : segments_) {
      for (Segment& segment : row) segment.region = rank[static_cast<std::size_t>(segment.region)];
    }
    return PixelsByRank(found, rank);
  }

  [[nodiscard]] const Segments& Of(int row) const { return segments_[static_cast<std::size_t>(row)]; }

 private:
  void JoinToAbove(int row) {
    const Segments &above = segments_[static_cast<std::size_t>(row) - 1],
                   &here = segments_[static_cast<std::size_t>(row)];
    const Cuts& cuts = down_cuts_[static_cast<std::size_t>(row) - 1];
    const float *up = wrapped_.Row(row - 1), *at = wrapped_.Row(row);
    std::int32_t joined_above = -1, joined_here = -1;
    for (auto a = above.begin(), b = here.begin(); a != above.end() && b != here.end();) {
      const int last = std::min(a->last, b->last);
      int x = std::max(a->first, b->first);
      if (a->piece != joined_above || b->piece != joined_here) {
        while (x < last && std::binary_search(cuts.begin(), cuts.end(), x)) ++x;
        if (x < last) {
          sheets_.Join(a->piece, b->piece, StepBetween(up[x], at[x]) + a->turns - b->turns);
          joined_above = a->piece;
          joined_here = b->piece;
        }
      }
      a->last < b->last ? ++a : ++b;
    }
  }

  const ImageF& wrapped_;
  std::vector<Segments> segments_;
  std::vector<Cuts> down_cuts_;
  Sheets sheets_{0};
};

}  // namespace

Unwrapped UnwrapBetweenCuts(ImageF wrapped, const Mask& mask, const std::vector<std::uint32_t>& cuts) {
  Rows rows(wrapped, mask, cuts);
  const int width = wrapped.width(), height = wrapped.height();
  Unwrapped out{std::move(wrapped), Image<std::int32_t>::Unset(width, height), 0, rows.Settle()};
  out.regions = static_cast<int>(out.pixels.size());
  TouchPages(out.region);
  ParallelLines(height, [&](int row) {
    float* phase = out.phase.Row(row);
    std::int32_t* region = out.region.Row(row);
    int done = 0;
    const auto leave_out = [&](int until) {
      std::fill(phase + done, phase + until, std::numeric_limits<float>::quiet_NaN());
      std::fill(region + done, region + until, -1);
    };
    for (const Segment& segment : rows.Of(row)) {
      leave_out(segment.first);
      const float turns = kTurn * static_cast<float>(segment.turns);
      for (int x = segment.first; x < segment.last; ++x) phase[x] += turns;
      std::fill(region + segment.first, region + segment.last, segment.region);
      done = segment.last;
    }
    leave_out(width);
  });
  return out;
}

}  // namespace striae::reconstruct::detail
