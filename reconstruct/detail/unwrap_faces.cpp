#include "reconstruct/detail/unwrap_faces.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/vector.h"
#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {
namespace {

/// Steps from every pixel of a row to another one's beside or below it; 0 where the edge is missing.
STRIAE_VECTORISED void StepsTo(const float* phase, const std::uint8_t* mask, const float* other,
                               const std::uint8_t* other_mask, int count, std::int8_t* steps) {
  for (int x = 0; x < count; ++x) {
    const auto edge = static_cast<std::int8_t>(mask[x] & other_mask[x]);
    steps[x] = static_cast<std::int8_t>(edge * static_cast<std::int8_t>(StepBetween(phase[x], other[x])));
  }
}

/// Turns by which the way around the faces below a row does not close.
STRIAE_VECTORISED void Curl(const std::int8_t* above, const std::int8_t* below, const std::int8_t* down, int count,
                            std::int8_t* curl) {
  for (int x = 0; x < count; ++x) curl[x] = static_cast<std::int8_t>(above[x] + down[x + 1] - below[x] - down[x]);
}

/// Calls visit(index) where a value is not 0, eight at a time. `bytes` is padded to whole words with zeros.
template <typename Visit>
void ForEachSet(const std::vector<std::int8_t>& bytes, const Visit& visit) {
  for (std::size_t i = 0; i < bytes.size(); i += 8) {
    std::uint64_t word;
    std::memcpy(&word, bytes.data() + i, sizeof word);
    for (std::size_t k = i; word != 0; ++k, word >>= 8) {
      if ((word & 0xff) != 0) visit(static_cast<int>(k));
    }
  }
}

}  // namespace

/// The steps along two rows and between them, kept from row to row.
class Faces::Scanner {
 public:
  Scanner(const ImageF& wrapped, const Mask& mask)
      : wrapped_(wrapped), mask_(mask), padded_((static_cast<std::size_t>(mask.width()) + 7) / 8 * 8) {
    for (auto* bytes : {&above_, &below_, &down_, &curl_}) bytes->assign(padded_, 0);
  }

  /// Rows must be asked for in ascending order, without gaps.
  void Scan(int row, std::vector<Run>& runs, std::vector<Residue>& residues) {
    const int width = mask_.width();
    const std::uint8_t *ma = mask_.Row(row), *mb = mask_.Row(row + 1);
    if (scanned_ != row) StepsRight(row, above_);
    StepsRight(row + 1, below_);
    StepsTo(wrapped_.Row(row), ma, wrapped_.Row(row + 1), mb, width, down_.data());
    Curl(above_.data(), below_.data(), down_.data(), width - 1, curl_.data());
    ForEachSet(curl_, [&](int x) { residues.push_back({x, curl_[static_cast<std::size_t>(x)]}); });
    std::swap(above_, below_);
    scanned_ = row + 1;
    FindRuns(ma, mb, runs);
  }

 private:
  void StepsRight(int row, std::vector<std::int8_t>& steps) {
    const float* phase = wrapped_.Row(row);
    const std::uint8_t* mask = mask_.Row(row);
    StepsTo(phase, mask, phase + 1, mask + 1, mask_.width() - 1, steps.data());
  }
  /// A missing edge downwards at x joins the faces x - 1 and x.
  void FindRuns(const std::uint8_t* ma, const std::uint8_t* mb, std::vector<Run>& runs) {
    const int width = mask_.width();
    both_.resize(static_cast<std::size_t>(width));
    for (std::size_t x = 0; x < both_.size(); ++x) both_[x] = ma[x] & mb[x];
    const std::uint8_t *begin = both_.data(), *end = begin + width;
    for (const std::uint8_t* at = begin; at != end;) {
      const auto* first = static_cast<const std::uint8_t*>(std::memchr(at, 0, static_cast<std::size_t>(end - at)));
      if (first == nullptr) break;
      const auto* last = static_cast<const std::uint8_t*>(std::memchr(first, 1, static_cast<std::size_t>(end - first)));
      if (last == nullptr) last = end;
      runs.push_back({static_cast<int>(first - begin) - 1, static_cast<int>(last - begin) - 1});
      at = last;
    }
  }

  const ImageF& wrapped_;
  const Mask& mask_;
  std::size_t padded_;
  int scanned_ = -1;  ///< row whose steps to the right are in above_
  std::vector<std::int8_t> above_, below_, down_, curl_;
  std::vector<std::uint8_t> both_;
};

Faces::Faces(const ImageF& wrapped, const Mask& mask, std::size_t most_residues)
    : width_(mask.width()), height_(mask.height()) {
  const auto rows = static_cast<std::size_t>(std::max(0, height_ - 1));
  std::vector<std::vector<Run>> runs(rows);
  std::vector<std::vector<Residue>> residues(rows);
  ParallelBlocks(static_cast<int>(rows), [&](int, int first, int last) {
    Scanner scanner(wrapped, mask);
    for (int row = first; row < last; ++row) {
      const auto at = static_cast<std::size_t>(row);
      scanner.Scan(row, runs[at], residues[at]);
    }
  });
  std::size_t count = 0;
  for (const auto& row : residues) count += row.size();
  overcharged_ = count > most_residues;
  if (overcharged_) return;
  JoinRuns(runs, mask);
  for (std::size_t row = 0; row < rows; ++row) {
    for (const Residue& residue : residues[row]) {
      const std::int32_t face = At(residue.x, static_cast<int>(row));
      Node(face).charge += residue.charge;
      if (face != kOutside) charged_.push_back(face);
    }
  }
  std::sort(charged_.begin(), charged_.end());
  charged_.erase(std::unique(charged_.begin(), charged_.end()), charged_.end());
}

void Faces::JoinRuns(const std::vector<std::vector<Run>>& runs, const Mask& mask) {
  nodes_.assign(1, FaceNode{});
  const auto missing_right = [&](int first, int last, int row) {
    const std::uint8_t* m = mask.Row(row);
    for (int x = first; x <= last; ++x) {
      if ((m[x] & m[x + 1]) == 0) return true;
    }
    return false;
  };
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const int row = static_cast<int>(r);
    row_starts_.push_back(static_cast<std::int32_t>(nodes_.size()));
    for (const Run& run : runs[r]) {
      const auto node = static_cast<std::int32_t>(nodes_.size());
      const int first = std::max(0, run.first), last = std::min(width_ - 2, run.last);
      nodes_.push_back({-1, 0, row, first, last});
      const bool open = run.first < 0 || run.last >= width_ - 1 || (row == 0 && missing_right(first, last, 0)) ||
                        (row == height_ - 2 && missing_right(first, last, height_ - 1));
      if (open) Unite(kOutside, node);
    }
    if (r == 0) continue;
    const std::int32_t above_end = row_starts_[r], end = static_cast<std::int32_t>(nodes_.size());
    for (std::int32_t a = row_starts_[r - 1], b = above_end; a < above_end && b < end;) {
      if (missing_right(std::max(Node(a).first, Node(b).first), std::min(Node(a).last, Node(b).last), row)) Unite(a, b);
      Node(a).last < Node(b).last ? ++a : ++b;
    }
  }
  row_starts_.push_back(static_cast<std::int32_t>(nodes_.size()));
}

std::int32_t Faces::Root(std::int32_t node) {
  while (Node(node).parent >= 0) {
    const std::int32_t up = Node(node).parent;
    if (Node(up).parent >= 0) Node(node).parent = Node(up).parent;
    node = up;
  }
  return node;
}

void Faces::Unite(std::int32_t a, std::int32_t b) {
  a = Root(a);
  b = Root(b);
  if (a == b) return;
  if (b < a) std::swap(a, b);  // the outside, 0, stays a root
  Node(b).parent = a;
  Node(Node(a).tail < 0 ? a : Node(a).tail).next = b;
  Node(a).tail = Node(b).tail < 0 ? b : Node(b).tail;
}

std::int32_t Faces::At(int x, int row) {
  if (x < 0 || row < 0 || x >= width_ - 1 || row >= height_ - 1) return kOutside;
  // Runs of a row stand in order.
  const auto begin = nodes_.begin() + row_starts_[static_cast<std::size_t>(row)];
  const auto end = nodes_.begin() + row_starts_[static_cast<std::size_t>(row) + 1];
  const auto run = std::partition_point(begin, end, [x](const FaceNode& node) { return node.last < x; });
  if (run != end && run->first <= x) return Root(static_cast<std::int32_t>(run - nodes_.begin()));
  const auto next = static_cast<std::int32_t>(nodes_.size());
  const auto [found, fresh] = whole_.try_emplace(static_cast<std::int64_t>(row) * width_ + x, next);
  if (fresh) nodes_.push_back({-1, 0, row, x, x});
  return found->second;
}

void Faces::AppendEdges(std::int32_t face, const Edges& edges, std::vector<std::uint64_t>& out) const {
  for (std::int32_t n = face; n >= 0; n = Node(n).next) {
    const auto& [parent, charge, row, first, last, next, tail] = Node(n);
    if (row < 0) continue;
    for (int x = first; x <= last; ++x) {
      if (edges.HasRight(x, row)) out.push_back(edges.Right(x, row));
      if (edges.HasRight(x, row + 1)) out.push_back(edges.Right(x, row + 1));
    }
    if (edges.HasDown(first, row)) out.push_back(edges.Down(first, row));
    if (edges.HasDown(last + 1, row)) out.push_back(edges.Down(last + 1, row));
  }
}

}  // namespace striae::reconstruct::detail
