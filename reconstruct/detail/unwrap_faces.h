// The faces of the masked pixel grid: unit squares between four pixels, joined where the mask takes an edge away.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "reconstruct/detail/unwrap_edges.h"

namespace striae::reconstruct::detail {

/// Faces by number. Number kOutside is everything around the image and what the mask joins to it. Faces at missing
/// edges are found as runs along rows and joined; a whole one (all four edges there) gets a number when it is asked
/// for.
class Faces {
 public:
  static constexpr std::int32_t kOutside = 0;

  /// Finds residues and holes; rows in parallel. With more than `most_residues` nothing else is done.
  Faces(const ImageF& wrapped, const Mask& mask, std::size_t most_residues);
  [[nodiscard]] bool overcharged() const { return overcharged_; }

  /// Face (x, row) has the corners (x, row) and (x + 1, row + 1); beyond the image it is kOutside.
  std::int32_t At(int x, int row);
  [[nodiscard]] std::size_t count() const { return nodes_.size(); }
  /// Turns by which the wrapped phase does not close around the face.
  [[nodiscard]] std::int32_t charge(std::int32_t face) const { return Node(face).charge; }
  /// Numbers of the faces that hold residues, each once, kOutside left out.
  [[nodiscard]] const std::vector<std::int32_t>& charged() const { return charged_; }
  /// Appends the edges around a face, with their rank (Edges::Right, Edges::Down).
  void AppendEdges(std::int32_t face, const Edges& edges, std::vector<std::uint64_t>& out) const;

 private:
  struct Run {
    int first, last;  ///< faces [first, last] of a row; -1 and width - 1 stand for the outside
  };
  struct FaceNode {
    std::int32_t parent = -1, charge = 0;
    int row = -1, first = 0, last = 0;
    std::int32_t next = -1, tail = -1;  ///< list of the runs that are joined
  };
  struct Residue {
    int x;
    std::int32_t charge;
  };
  class Scanner;
  void JoinRuns(const std::vector<std::vector<Run>>& runs, const Mask& mask);
  std::int32_t Root(std::int32_t node);
  void Unite(std::int32_t a, std::int32_t b);
  FaceNode& Node(std::int32_t n) { return nodes_[static_cast<std::size_t>(n)]; }
  [[nodiscard]] const FaceNode& Node(std::int32_t n) const { return nodes_[static_cast<std::size_t>(n)]; }

  int width_, height_;  ///< of the image
  std::vector<FaceNode> nodes_;
  std::vector<std::int32_t> row_starts_;                  ///< first run node of every row of faces
  std::unordered_map<std::int64_t, std::int32_t> whole_;  ///< numbers of whole faces
  std::vector<std::int32_t> charged_;
  bool overcharged_ = false;
};

}  // namespace striae::reconstruct::detail
