#include "acquire/rig/blocks.h"

#include <algorithm>
#include <cmath>

namespace striae::rig {
namespace {

/// A parallelogram of its own vertices, so that its normal is flat; outside is towards `down` x `right`.
void AppendFace(const Eigen::Vector3d& corner, const Eigen::Vector3d& right, const Eigen::Vector3d& down, double albedo,
                TriangleMesh& mesh) {
  constexpr int kSide = 12;
  TriangleMesh face;
  for (int row = 0; row <= kSide; ++row) {
    for (int column = 0; column <= kSide; ++column) {
      face.vertex.push_back(corner + column * right / kSide + row * down / kSide);
    }
  }
  face.albedo.assign(face.vertex.size(), Eigen::Vector3f::Constant(static_cast<float>(albedo)));
  AppendGridTriangles(0, kSide + 1, kSide + 1, false, face);
  ComputeNormals(face);
  Append(face, mesh);
}

}  // namespace

Eigen::Vector3d BlockCenter(const BlocksOptions& o, std::size_t i) {
  const double middle = (static_cast<double>(o.heights_mm.size()) - 1) / 2;
  return {2 * o.block_mm * (static_cast<double>(i) - middle), 0, -o.heights_mm.at(i)};
}

Result<TriangleMesh> MakeBlocks(const BlocksOptions& o) {
  const bool positive = std::all_of(o.heights_mm.begin(), o.heights_mm.end(),
                                    [](double height) { return height > 0 && std::isfinite(height); });
  if (o.heights_mm.empty() || !positive || !(o.block_mm > 0)) {
    return Fail(ErrorCode::kUsage, "blocks need positive heights and a positive side");
  }
  if (!((2 * static_cast<double>(o.heights_mm.size()) - 1) * o.block_mm < o.plate_width_mm) ||
      !(o.block_mm < o.plate_height_mm)) {
    return Fail(ErrorCode::kUsage, "the blocks do not fit onto the plate; make them fewer or smaller");
  }
  TriangleMesh mesh;
  AppendFace({-o.plate_width_mm / 2, -o.plate_height_mm / 2, 0}, {o.plate_width_mm, 0, 0}, {0, o.plate_height_mm, 0},
             o.albedo, mesh);
  for (std::size_t i = 0; i < o.heights_mm.size(); ++i) {
    const double s = o.block_mm, h = o.heights_mm[i];
    const Eigen::Vector3d corner = BlockCenter(o, i) - Eigen::Vector3d(s / 2, s / 2, 0);
    const Eigen::Vector3d right(s, 0, 0), down(0, s, 0), back(0, 0, h);
    AppendFace(corner, right, down, o.albedo, mesh);
    AppendFace(corner + back, right, -back, o.albedo, mesh);  // upper side
    AppendFace(corner + down, right, back, o.albedo, mesh);   // lower side
    AppendFace(corner + back, -back, down, o.albedo, mesh);   // left side
    AppendFace(corner + right, back, down, o.albedo, mesh);   // right side
  }
  return mesh;
}

}  // namespace striae::rig
