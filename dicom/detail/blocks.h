// The full mesh, seen in blocks of k x k sensor pixels: which faces lie in a block, and what hangs together in it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/surface.h"

namespace striae::dicom::detail {

/// Faces sorted by block. A face belongs to the block of its smallest column and row.
class BlockFaces {
 public:
  BlockFaces(const Surface& surface, int step);
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  /// Indices of the faces of block (bx, by).
  [[nodiscard]] std::span<const std::uint32_t> Of(int bx, int by) const;

 private:
  int columns_, rows_;
  std::vector<std::uint32_t> begin_;  ///< columns * rows + 1 offsets into faces_
  std::vector<std::uint32_t> faces_;
};

/// One block's vertices (its k + 1 columns and rows) with the parts that its faces join; reused block after block.
class BlockMesh {
 public:
  BlockMesh(const Surface& surface, const Image<std::int32_t>& index, int step);
  void Load(int bx, int by, std::span<const std::uint32_t> faces);

  [[nodiscard]] int step() const { return step_; }
  /// Vertex of the full mesh at (x, y) within the block, 0..step; nullopt outside the sensor or without a point.
  [[nodiscard]] std::optional<std::uint32_t> VertexAt(int x, int y) const;
  /// True if faces of this block lead from one to the other.
  [[nodiscard]] bool SamePart(const std::array<int, 2>& a, const std::array<int, 2>& b) const;

 private:
  [[nodiscard]] std::size_t Local(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(step_ + 1) + static_cast<std::size_t>(x);
  }
  [[nodiscard]] std::size_t Root(std::size_t local) const;

  const Surface* surface_;
  const Image<std::int32_t>* index_;
  int step_, col0_ = 0, row0_ = 0;
  std::vector<std::size_t> parent_;
};

}  // namespace striae::dicom::detail
