#include "acquire/rig/detail/paint.h"

#include <cmath>

#include <Eigen/Geometry>

namespace striae::rig::detail {

Eigen::Vector3f SkinAlbedo(const TriangleMesh& mesh, const Hit& where) {
  const auto& t = mesh.triangle[where.triangle];
  return (1 - where.u - where.v) * mesh.albedo[t[0]] + where.u * mesh.albedo[t[1]] + where.v * mesh.albedo[t[2]];
}

std::optional<float> PaintAt(const TriangleMesh& mesh, const Eigen::Vector3d& point) {
  for (auto decal = mesh.decal.rbegin(); decal != mesh.decal.rend(); ++decal) {
    const Eigen::Vector3d from = point - decal->origin;
    if (std::abs(decal->right.cross(decal->down).dot(from)) > decal->reach_mm) continue;
    const double column = std::floor(decal->right.dot(from) / decal->cell_mm + 0.5 * decal->columns);
    const double row = std::floor(decal->down.dot(from) / decal->cell_mm + 0.5 * decal->rows);
    if (column < 0 || row < 0 || column >= decal->columns || row >= decal->rows) continue;
    return decal->albedo[static_cast<std::size_t>(row) * static_cast<std::size_t>(decal->columns) +
                         static_cast<std::size_t>(column)];
  }
  return std::nullopt;
}

bool NearPaint(const TriangleMesh& mesh, const Eigen::Vector3d& point, double margin_mm) {
  for (const Decal& decal : mesh.decal) {
    const Eigen::Vector3d from = point - decal.origin;
    if (std::abs(decal.right.dot(from)) < 0.5 * decal.columns * decal.cell_mm + margin_mm &&
        std::abs(decal.down.dot(from)) < 0.5 * decal.rows * decal.cell_mm + margin_mm) {
      return true;
    }
  }
  return false;
}

}  // namespace striae::rig::detail
