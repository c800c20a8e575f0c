#include "acquire/rig/detail/paint.h"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "acquire/rig/detail/srgb.h"

namespace striae::rig::detail {

namespace {

const std::array<float, 256>& LinearOfByte() {
  static const auto table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = FromSrgb(static_cast<float>(i) / 255);
    return values;
  }();
  return table;
}

/// The picture's linear colour between the centres of its four nearest pixels; it repeats beyond its borders.
Eigen::Vector3f PictureAt(const ImageRgb& picture, const Eigen::Vector2f& uv) {
  const auto& linear = LinearOfByte();
  const float x = (uv.x() - std::floor(uv.x())) * static_cast<float>(picture.width()) - 0.5F;
  const float y = (uv.y() - std::floor(uv.y())) * static_cast<float>(picture.height()) - 0.5F;
  const int col = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
  const float u = x - static_cast<float>(col), v = y - static_cast<float>(row);
  const auto at = [&](int c, int r) {
    const Rgb8 p = picture((c + picture.width()) % picture.width(), (r + picture.height()) % picture.height());
    return Eigen::Vector3f(linear[p.r], linear[p.g], linear[p.b]);
  };
  return (1 - v) * ((1 - u) * at(col, row) + u * at(col + 1, row)) +
         v * ((1 - u) * at(col, row + 1) + u * at(col + 1, row + 1));
}

}  // namespace

Eigen::Vector3f SkinAlbedo(const TriangleMesh& mesh, const Hit& where) {
  const auto& t = mesh.triangle[where.triangle];
  const float w = 1 - where.u - where.v;
  const Eigen::Vector3f albedo = w * mesh.albedo[t[0]] + where.u * mesh.albedo[t[1]] + where.v * mesh.albedo[t[2]];
  const int texture = mesh.texture_of_triangle.empty() ? -1 : mesh.texture_of_triangle[where.triangle];
  if (texture < 0) return albedo;
  const Eigen::Vector2f uv = w * mesh.uv[t[0]] + where.u * mesh.uv[t[1]] + where.v * mesh.uv[t[2]];
  if (!uv.allFinite()) return albedo;
  return albedo.cwiseProduct(PictureAt(*mesh.texture[static_cast<std::size_t>(texture)], uv));
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
