// Union-find whose elements carry a whole number of turns relative to their root; regions by size.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace striae::reconstruct::detail {

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
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  void Prefetch(std::int32_t element) const { __builtin_prefetch(nodes_.data() + element); }

 private:
  struct Node {
    std::int32_t parent = -1, turns = 0;
  };
  Node& At(std::int32_t element) { return nodes_[static_cast<std::size_t>(element)]; }
  std::vector<Node> nodes_;
};

/// A region as it is met in row order: the turns of its first pixel are taken off all others.
struct RegionFound {
  std::int64_t pixels = 0;
  std::int32_t first_turns = 0;
};

/// Place of every region when the largest comes first, equal ones as they were met.
inline std::vector<std::int32_t> RankBySize(const std::vector<RegionFound>& regions) {
  std::vector<std::int32_t> order(regions.size()), rank(regions.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return regions[static_cast<std::size_t>(a)].pixels > regions[static_cast<std::size_t>(b)].pixels;
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    rank[static_cast<std::size_t>(order[i])] = static_cast<std::int32_t>(i);
  return rank;
}

inline std::vector<std::size_t> PixelsByRank(const std::vector<RegionFound>& regions,
                                             const std::vector<std::int32_t>& rank) {
  std::vector<std::size_t> pixels(regions.size());
  for (std::size_t i = 0; i < regions.size(); ++i)
    pixels[static_cast<std::size_t>(rank[i])] = static_cast<std::size_t>(regions[i].pixels);
  return pixels;
}

}  // namespace striae::reconstruct::detail
