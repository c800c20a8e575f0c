#include <algorithm>
#include <utility>
#include <vector>

#include "reconstruct/detail/unwrap_faces.h"
#include "reconstruct/detail/unwrap_forms.h"

namespace striae::reconstruct::detail {
namespace {

/// An edge of the maximum spanning tree of the faces: it separates a from b.
struct TreeEdge {
  std::int32_t a, b;
  std::uint32_t edge;
};

/// Grows the parts of the tree that carry flow.
class TreeGrowth {
 public:
  TreeGrowth(Faces& faces, const Edges& edges, std::size_t budget) : faces_(faces), edges_(edges), budget_(budget) {}

  /// False when the budget is spent.
  bool Grow() {
    Fit();
    for (const std::int32_t face : faces_.charged()) Open(face);
    for (const std::int32_t face : faces_.charged()) {
      std::int32_t cluster = Root(face);
      while (clusters_[Index(cluster)].charge != 0 && cluster != Root(Faces::kOutside)) {
        if (spent_ > budget_) return false;
        cluster = Extend(cluster);
      }
    }
    return true;
  }
  [[nodiscard]] const std::vector<TreeEdge>& tree() const { return tree_; }

 private:
  struct Cluster {
    std::int32_t parent = -1, charge = 0;
    bool open = false;                ///< its edges are in the heap
    std::vector<std::uint64_t> heap;  ///< edges by rank, the least reliable on top; inner ones among them
  };
  static std::size_t Index(std::int32_t n) { return static_cast<std::size_t>(n); }
  void Fit() { clusters_.resize(faces_.count()); }

  std::int32_t Root(std::int32_t n) {
    while (clusters_[Index(n)].parent >= 0) {
      const std::int32_t up = clusters_[Index(n)].parent;
      if (clusters_[Index(up)].parent >= 0) clusters_[Index(n)].parent = clusters_[Index(up)].parent;
      n = up;
    }
    return n;
  }

  void Open(std::int32_t face) {
    Cluster& cluster = clusters_[Index(face)];
    if (cluster.open || face == Faces::kOutside) return;
    cluster.open = true;
    cluster.charge = faces_.charge(face);
    faces_.AppendEdges(face, edges_, cluster.heap);
    std::make_heap(cluster.heap.begin(), cluster.heap.end());
    spent_ += cluster.heap.size();
  }

  /// The least reliable edge around a cluster is in the tree (cut property); returns the cluster joined across it.
  std::int32_t Extend(std::int32_t cluster) {
    auto& heap = clusters_[Index(cluster)].heap;
    std::pop_heap(heap.begin(), heap.end());
    const auto edge = static_cast<std::uint32_t>(heap.back());
    heap.pop_back();
    ++spent_;
    const int pixel = static_cast<int>(edge / 2), x = pixel % edges_.width(), row = pixel / edges_.width();
    const bool down = (edge & 1U) != 0;
    const std::int32_t a = faces_.At(x, row), b = down ? faces_.At(x - 1, row) : faces_.At(x, row - 1);
    Fit();
    const std::int32_t root_a = Root(a), root_b = Root(b);
    if (root_a == root_b) return cluster;
    tree_.push_back({a, b, edge});
    return Merge(cluster, root_a == cluster ? root_b : root_a);
  }

  std::int32_t Merge(std::int32_t cluster, std::int32_t other) {
    if (other == Root(Faces::kOutside)) {
      clusters_[Index(cluster)].parent = other;
      clusters_[Index(cluster)].heap = {};
      return other;
    }
    Open(other);
    if (clusters_[Index(cluster)].heap.size() < clusters_[Index(other)].heap.size()) std::swap(cluster, other);
    Cluster &keep = clusters_[Index(cluster)], &give = clusters_[Index(other)];
    for (const std::uint64_t edge : give.heap) {
      keep.heap.push_back(edge);
      std::push_heap(keep.heap.begin(), keep.heap.end());
    }
    spent_ += give.heap.size();
    give.heap = {};
    give.parent = cluster;
    keep.charge += give.charge;
    return cluster;
  }

  Faces& faces_;
  const Edges& edges_;
  std::size_t budget_, spent_ = 0;
  std::vector<Cluster> clusters_;
  std::vector<TreeEdge> tree_;
};

/// Takes leaves off the trees; an edge is cut when what hangs on its leaf is charged.
std::vector<std::uint32_t> CarryingFlow(const std::vector<TreeEdge>& tree, const Faces& faces) {
  struct End {
    std::int32_t degree = 0, charge = 0;
    std::size_t edges = 0;  ///< exclusive or of its edges' numbers: of a leaf, its only edge
  };
  std::vector<End> ends(faces.count());
  const auto at = [&](std::int32_t face) -> End& { return ends[static_cast<std::size_t>(face)]; };
  for (std::size_t i = 0; i < tree.size(); ++i) {
    for (const std::int32_t face : {tree[i].a, tree[i].b}) {
      ++at(face).degree;
      at(face).edges ^= i;
      at(face).charge = faces.charge(face);
    }
  }
  std::vector<std::int32_t> leaves;
  for (std::int32_t face = 1; face < static_cast<std::int32_t>(ends.size()); ++face) {
    if (at(face).degree == 1) leaves.push_back(face);
  }
  std::vector<std::uint32_t> cuts;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    End& leaf = at(leaves[i]);
    if (leaf.degree != 1) continue;
    const TreeEdge& edge = tree[leaf.edges];
    const std::int32_t inner = edge.a == leaves[i] ? edge.b : edge.a;
    if (leaf.charge != 0) cuts.push_back(edge.edge);
    leaf.degree = 0;
    End& rest = at(inner);
    rest.charge += leaf.charge;
    rest.edges ^= leaf.edges;
    if (--rest.degree == 1 && inner != Faces::kOutside) leaves.push_back(inner);
  }
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

}  // namespace

std::optional<std::vector<std::uint32_t>> FindCuts(const Edges& edges, std::size_t budget) {
  Faces faces(edges.wrapped(), edges.mask(), budget / 4);  // each puts four edges into a heap
  if (faces.overcharged()) return std::nullopt;
  TreeGrowth growth(faces, edges, budget);
  if (!growth.Grow()) return std::nullopt;
  return CarryingFlow(growth.tree(), faces);
}

}  // namespace striae::reconstruct::detail
