#include "reconstruct/unwrap.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct {
namespace {

constexpr float kTwoPi = 2 * std::numbers::pi_v<float>;
constexpr float kLeastReliable = 1e6F;  // above any D: second differences are at most 4 pi

float Wrap(float difference) { return difference - kTwoPi * std::nearbyint(difference / kTwoPi); }

/// D of every pixel.
ImageF Unreliability(const ImageF& phase, const Mask& mask) {
  const int width = phase.width(), height = phase.height();
  ImageF d(width, height, kLeastReliable);
  detail::ParallelLines(height, [&](int row) {
    if (row == 0 || row == height - 1) return;
    const float *up = phase.Row(row - 1), *at = phase.Row(row), *down = phase.Row(row + 1);
    const std::uint8_t *mu = mask.Row(row - 1), *ma = mask.Row(row), *md = mask.Row(row + 1);
    float* out = d.Row(row);
    for (int x = 1; x + 1 < width; ++x) {
      if ((mu[x - 1] & mu[x] & mu[x + 1] & ma[x - 1] & ma[x] & ma[x + 1] & md[x - 1] & md[x] & md[x + 1]) == 0)
        continue;
      const auto second = [&](float before, float after) { return Wrap(before - at[x]) - Wrap(at[x] - after); };
      const float h = second(at[x - 1], at[x + 1]), v = second(up[x], down[x]);
      const float a = second(up[x - 1], down[x + 1]), b = second(up[x + 1], down[x - 1]);
      out[x] = h * h + v * v + a * a + b * b;
    }
  });
  return d;
}

/// Edges in ascending order of weight, by a radix sort in two passes on a logarithmic key (22 bits of a float's own
/// bits). An edge is 2 * pixel for the one to the right, 2 * pixel + 1 for the one downwards. Both passes are stable,
/// and every block writes where its predecessors end: the order is that of one thread, however many there are.
class EdgeSorter {
 public:
  EdgeSorter(const ImageF& d, const Mask& mask) : d_(d), mask_(mask), blocks_(detail::ThreadCount()) {}

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

  static std::uint32_t KeyOf(float weight) {
    constexpr std::uint32_t kSmallest = 0x30000000U;  // 4.7e-10: below it, edges are equally perfect
    const auto bits = std::bit_cast<std::uint32_t>(weight);
    return bits < kSmallest ? 0 : std::min(kDigits * kDigits - 1, (bits - kSmallest) >> 8);
  }

  [[nodiscard]] std::size_t Blocks() const { return static_cast<std::size_t>(blocks_); }

  /// Calls body(block, first, last) with one block for each thread.
  template <typename Body>
  void InBlocks(std::size_t count, const Body& body) const {
    detail::ParallelBlocks(
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
        if (x + 1 < width && m[x + 1] != 0) visit(KeyOf(d[x] + d[x + 1]), edge);
        if (below != nullptr && mask_below[x] != 0) visit(KeyOf(d[x] + below[x]), edge + 1);
      }
    }
  }

  const ImageF& d_;
  const Mask& mask_;
  int blocks_;
};

/// Union-find whose elements carry a whole number of turns relative to their root.
class Sheets {
 public:
  explicit Sheets(std::size_t count) : nodes_(count) {}

  struct Place {
    std::int32_t root, turns;
  };
  Place Find(std::int32_t element) {
    std::int32_t turns = 0;
    for (;;) {
      Node& node = At(element);
      if (node.parent < 0) return {element, turns};
      const Node& up = At(node.parent);
      if (up.parent < 0) return {node.parent, turns + node.turns};
      node.turns += up.turns;  // path halving
      node.parent = up.parent;
      turns += node.turns;
      element = node.parent;
    }
  }
  /// Makes turns(b) = turns(a) + step.
  void Join(std::int32_t a, std::int32_t b, std::int32_t step) {
    const Place pa = Find(a), pb = Find(b);
    if (pa.root == pb.root) return;
    const std::int32_t between = pa.turns + step - pb.turns;
    const bool a_larger = At(pa.root).parent <= At(pb.root).parent;  // roots hold minus their size
    const std::int32_t keep = a_larger ? pa.root : pb.root, give = a_larger ? pb.root : pa.root;
    At(keep).parent += At(give).parent;
    At(give) = {keep, a_larger ? between : -between};
  }
  [[nodiscard]] std::int32_t SizeOfRoot(std::int32_t root) { return -At(root).parent; }
  void Prefetch(std::int32_t element) const { __builtin_prefetch(nodes_.data() + element); }

 private:
  struct Node {
    std::int32_t parent = -1, turns = 0;
  };
  Node& At(std::int32_t element) { return nodes_[static_cast<std::size_t>(element)]; }
  std::vector<Node> nodes_;
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
    sheets.Join(a, b, -static_cast<std::int32_t>(std::nearbyint((phase[b] - phase[a]) / kTwoPi)));
  }
}

void Write(Sheets& sheets, const ImageF& wrapped, const Mask& mask, Unwrapped& out) {
  const auto count = static_cast<std::int32_t>(wrapped.size());
  struct Root {
    std::int32_t root, size, first_turns;
  };
  std::vector<Root> roots;
  Image<std::int32_t>& region = out.region;
  std::vector<std::int32_t> number(static_cast<std::size_t>(count), -1);  // of a root, in the order of appearance
  for (std::int32_t i = 0; i < count; ++i) {
    if (mask.pixels()[static_cast<std::size_t>(i)] == 0) continue;
    const auto place = sheets.Find(i);
    auto& known = number[static_cast<std::size_t>(place.root)];
    if (known < 0) {
      known = static_cast<std::int32_t>(roots.size());
      roots.push_back({place.root, sheets.SizeOfRoot(place.root), place.turns});
    }
    region.pixels()[static_cast<std::size_t>(i)] = known;
    out.phase.pixels()[static_cast<std::size_t>(i)] =
        wrapped.pixels()[static_cast<std::size_t>(i)] +
        kTwoPi * static_cast<float>(place.turns - roots[static_cast<std::size_t>(known)].first_turns);
  }
  std::vector<std::int32_t> order(roots.size()), rank(roots.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return roots[static_cast<std::size_t>(a)].size > roots[static_cast<std::size_t>(b)].size;
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    rank[static_cast<std::size_t>(order[i])] = static_cast<std::int32_t>(i);
  for (std::int32_t& r : region.pixels()) r = r < 0 ? -1 : rank[static_cast<std::size_t>(r)];
  out.regions = static_cast<int>(roots.size());
}

}  // namespace

Unwrapped Unwrap(const ImageF& wrapped, const Mask& mask) {
  if (wrapped.width() != mask.width() || wrapped.height() != mask.height()) {
    throw std::logic_error("Unwrap: phase and mask differ in size");
  }
  if (wrapped.size() > std::size_t{1} << 30) throw std::logic_error("Unwrap: image too large");
  Unwrapped out{ImageF(wrapped.width(), wrapped.height(), std::numeric_limits<float>::quiet_NaN()),
                Image<std::int32_t>(wrapped.width(), wrapped.height(), -1), 0};
  Sheets sheets(wrapped.size());
  JoinAll(EdgeSorter(Unreliability(wrapped, mask), mask).Sorted(), wrapped, sheets);
  Write(sheets, wrapped, mask, out);
  return out;
}

}  // namespace striae::reconstruct
