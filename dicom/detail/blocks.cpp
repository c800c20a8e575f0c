#include "dicom/detail/blocks.h"

#include <algorithm>
#include <numeric>

namespace striae::dicom::detail {

BlockFaces::BlockFaces(const Surface& surface, int step)
    : columns_((surface.sensor_width_px + step - 1) / step), rows_((surface.sensor_height_px + step - 1) / step) {
  const auto block_of = [&](const std::array<std::uint32_t, 3>& face) {
    const int col = std::min({surface.col[face[0]], surface.col[face[1]], surface.col[face[2]]});
    const int row = std::min({surface.row[face[0]], surface.row[face[1]], surface.row[face[2]]});
    return static_cast<std::size_t>(row / step) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(col / step);
  };
  // Counting sort: offsets first, then each face into its place.
  begin_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  for (const auto& face : surface.faces) ++begin_[block_of(face) + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  faces_.resize(surface.faces.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t i = 0; i < faces_.size(); ++i) faces_[next[block_of(surface.faces[i])]++] = i;
}

std::span<const std::uint32_t> BlockFaces::Of(int bx, int by) const {
  const std::size_t block =
      static_cast<std::size_t>(by) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(bx);
  return std::span(faces_).subspan(begin_[block], begin_[block + 1] - begin_[block]);
}

BlockMesh::BlockMesh(const Surface& surface, const Image<std::int32_t>& index, int step)
    : surface_(&surface),
      index_(&index),
      step_(step),
      parent_(static_cast<std::size_t>(step + 1) * static_cast<std::size_t>(step + 1)) {}

void BlockMesh::Load(int bx, int by, std::span<const std::uint32_t> faces) {
  col0_ = bx * step_;
  row0_ = by * step_;
  std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  for (const std::uint32_t face : faces) {
    std::optional<std::size_t> first;
    for (const std::uint32_t vertex : surface_->faces[face]) {
      const int x = surface_->col[vertex] - col0_, y = surface_->row[vertex] - row0_;
      if (x > step_ || y > step_) continue;  // a face that spans several blocks joins nothing here
      const std::size_t root = Root(Local(x, y));
      if (first) {
        parent_[root] = *first;
      } else {
        first = root;
      }
    }
  }
}

std::optional<std::uint32_t> BlockMesh::VertexAt(int x, int y) const {
  if (!index_->Contains(col0_ + x, row0_ + y)) return std::nullopt;
  const std::int32_t vertex = (*index_)(col0_ + x, row0_ + y);
  if (vertex < 0) return std::nullopt;
  return static_cast<std::uint32_t>(vertex);
}

bool BlockMesh::SamePart(const std::array<int, 2>& a, const std::array<int, 2>& b) const {
  return Root(Local(a[0], a[1])) == Root(Local(b[0], b[1]));
}

std::size_t BlockMesh::Root(std::size_t local) const {
  while (parent_[local] != local) local = parent_[local];
  return local;
}

}  // namespace striae::dicom::detail
