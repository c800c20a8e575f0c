#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "reconstruct/detail/parallel.h"
#include "reconstruct/detail/unwrap_edges.h"
#include "reconstruct/detail/unwrap_forms.h"
#include "reconstruct/detail/unwrap_sheets.h"

namespace striae::reconstruct::detail {
namespace {

/// D of every pixel.
ImageF Unreliability(const Edges& edges) {
  ImageF d(edges.width(), edges.height());
  ParallelLines(d.height(), [&](int row) {
    for (int x = 0; x < d.width(); ++x) d(x, row) = edges.Unreliability(x, row);
  });
  return d;
}

/// Edges in ascending order of weight, by a radix sort in two passes on a logarithmic key (22 bits of a float's own
/// bits). Both passes are stable,
/// and every block writes where its predecessors end: the order is that of one thread, however many there are.
class EdgeSorter {
 public:
  EdgeSorter(const ImageF& d, const Mask& mask) : d_(d), mask_(mask), blocks_(ThreadCount()) {}

  [[nodiscard]] std::vector<std::uint32_t> Sorted() const {
    Counts low(Blocks(), Digits{}), high(Blocks(), Digits{});
    InBlocks(d_.height(), [&](std::size_t block, std::size_t first, std::size_t last) {
      ForEach(first, last, [&](std::uint32_t key, std::uint32_t) { ++low[block][key % kDigits]; });
    });
    const std::size_t count = Starts(low);
    std::vector<Half> half(count);
    InBlocks(d_.height(), [&](std::size_t block, std::size_t first, std::size_t last) {
      ForEach(first, last, [&](std::uint32_t key, std::uint32_t edge) {
        half[low[block][key % kDigits]++] = {key / kDigits, edge};
      });
    });
    InBlocks(count, [&](std::size_t block, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) ++high[block][half[i].high];
    });
    Starts(high);
    std::vector<std::uint32_t> edges(count);
    InBlocks(count, [&](std::size_t block, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) edges[high[block][half[i].high]++] = half[i].edge;
    });
    return edges;
  }

 private:
  static constexpr std::uint32_t kDigits = 1U << 11;
  using Digits = std::array<std::uint32_t, kDigits>;
  using Counts = std::vector<Digits>;
  struct Half {
    std::uint32_t high, edge;
  };

  [[nodiscard]] std::size_t Blocks() const { return static_cast<std::size_t>(blocks_); }

  /// Calls body(block, first, last) with one block for each thread.
  template <typename Body>
  void InBlocks(std::size_t count, const Body& body) const {
    ParallelBlocks(
        blocks_,
        [&](int, int first, int last) {
          for (auto block = static_cast<std::size_t>(first); block < static_cast<std::size_t>(last); ++block) {
            body(block, count * block / Blocks(), count * (block + 1) / Blocks());
          }
        },
        1);
  }

  /// Counts become the places where each block's edges of each digit start; returns the number of edges.
  static std::size_t Starts(Counts& counts) {
    std::uint32_t at = 0;
    for (std::size_t digit = 0; digit < kDigits; ++digit) {
      for (Digits& block : counts) at += std::exchange(block[digit], at);
    }
    return at;
  }

  template <typename Visit>
  void ForEach(std::size_t first_row, std::size_t last_row, const Visit& visit) const {
    const int width = d_.width(), height = d_.height();
    for (int row = static_cast<int>(first_row); row < static_cast<int>(last_row); ++row) {
      const float *d = d_.Row(row), *below = row + 1 < height ? d_.Row(row + 1) : nullptr;
      const std::uint8_t *m = mask_.Row(row), *mask_below = below != nullptr ? mask_.Row(row + 1) : nullptr;
      const auto first = static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(width);
      for (int x = 0; x < width; ++x) {
        if (m[x] == 0) continue;
        const std::uint32_t edge = 2 * (first + static_cast<std::uint32_t>(x));
        if (x + 1 < width && m[x + 1] != 0) visit(Edges::KeyOf(d[x] + d[x + 1]), edge);
        if (below != nullptr && mask_below[x] != 0) visit(Edges::KeyOf(d[x] + below[x]), edge + 1);
      }
    }
  }

  const ImageF& d_;
  const Mask& mask_;
  int blocks_;
};

/// Kruskal's algorithm: the most reliable edges join first.
void JoinAll(const std::vector<std::uint32_t>& edges, const ImageF& wrapped, Sheets& sheets) {
  constexpr std::size_t kAhead = 24;  // edges come in no spatial order: memory is asked for in time
  const float* phase = wrapped.pixels().data();
  const auto end_of = [&](std::uint32_t edge) {
    return static_cast<std::int32_t>(edge / 2) + ((edge & 1U) != 0 ? wrapped.width() : 1);
  };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i + kAhead < edges.size()) {
      const std::uint32_t soon = edges[i + kAhead];
      for (const std::int32_t pixel : {static_cast<std::int32_t>(soon / 2), end_of(soon)}) {
        sheets.Prefetch(pixel);
        __builtin_prefetch(phase + pixel);
      }
    }
    const auto a = static_cast<std::int32_t>(edges[i] / 2), b = end_of(edges[i]);
    sheets.Join(a, b, StepBetween(phase[a], phase[b]));
  }
}

}  // namespace

Unwrapped UnwrapByKruskal(const Edges& edges) {
  const ImageF& wrapped = edges.wrapped();
  const Mask& mask = edges.mask();
  Sheets sheets(wrapped.size());
  JoinAll(EdgeSorter(Unreliability(edges), mask).Sorted(), wrapped, sheets);
  Unwrapped out{ImageF(wrapped.width(), wrapped.height(), std::numeric_limits<float>::quiet_NaN()),
                Image<std::int32_t>(wrapped.width(), wrapped.height(), -1), 0};
  std::vector<RegionFound> found;
  std::vector<std::int32_t> number(wrapped.size(), -1);  // of a root, in the order of appearance
  for (std::size_t i = 0; i < wrapped.size(); ++i) {
    if (mask.pixels()[i] == 0) continue;
    const auto place = sheets.Find(static_cast<std::int32_t>(i));
    auto& known = number[static_cast<std::size_t>(place.root)];
    if (known < 0) {
      known = static_cast<std::int32_t>(found.size());
      found.push_back({0, place.turns});
    }
    RegionFound& region = found[static_cast<std::size_t>(known)];
    ++region.pixels;
    out.region.pixels()[i] = known;
    out.phase.pixels()[i] = wrapped.pixels()[i] + kTurn * static_cast<float>(place.turns - region.first_turns);
  }
  const std::vector<std::int32_t> rank = RankBySize(found);
  for (std::int32_t& r : out.region.pixels()) r = r < 0 ? -1 : rank[static_cast<std::size_t>(r)];
  out.regions = static_cast<int>(found.size());
  out.pixels = PixelsByRank(found, rank);
  return out;
}

}  // namespace striae::reconstruct::detail
