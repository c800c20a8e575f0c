#include "acquire/rig/mesh.h"

#include <numbers>

#include <Eigen/Geometry>

namespace striae::rig {

void AppendGridTriangles(std::size_t first, int columns, int rows, bool closed, TriangleMesh& mesh) {
  const auto index = [&](int column, int row) {
    return static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(row * columns + column % columns);
  };
  const int last_column = closed ? columns : columns - 1;
  mesh.triangle.reserve(mesh.triangle.size() +
                        2 * static_cast<std::size_t>(last_column) * static_cast<std::size_t>(rows));
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column < last_column; ++column) {
      const std::uint32_t a = index(column, row), b = index(column + 1, row);
      const std::uint32_t c = index(column, row + 1), d = index(column + 1, row + 1);
      // y runs downwards, so right-then-down is clockwise: down first makes it counter-clockwise from outside.
      mesh.triangle.push_back({a, c, b});
      mesh.triangle.push_back({b, c, d});
    }
  }
}

void ComputeNormals(TriangleMesh& mesh) {
  mesh.normal.assign(mesh.vertex.size(), Eigen::Vector3d::Zero());
  for (const auto& t : mesh.triangle) {
    const Eigen::Vector3d& a = mesh.vertex[t[0]];
    const Eigen::Vector3d area = (mesh.vertex[t[1]] - a).cross(mesh.vertex[t[2]] - a);
    for (const std::uint32_t corner : t) mesh.normal[corner] += area;
  }
  for (Eigen::Vector3d& n : mesh.normal) {
    const double length = n.norm();
    n = length > 0 ? Eigen::Vector3d(n / length) : Eigen::Vector3d(0, 0, -1);
  }
}

void Append(const TriangleMesh& part, TriangleMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertex.size());
  if (!part.texture.empty() || !mesh.texture.empty()) {
    const int first_texture = static_cast<int>(mesh.texture.size());
    mesh.uv.resize(mesh.vertex.size(), Eigen::Vector2f::Zero());
    mesh.texture_of_triangle.resize(mesh.triangle.size(), -1);
    mesh.uv.insert(mesh.uv.end(), part.uv.begin(), part.uv.end());
    for (const int texture : part.texture_of_triangle) {
      mesh.texture_of_triangle.push_back(texture < 0 ? -1 : texture + first_texture);
    }
    mesh.uv.resize(mesh.vertex.size() + part.vertex.size(), Eigen::Vector2f::Zero());
    mesh.texture_of_triangle.resize(mesh.triangle.size() + part.triangle.size(), -1);
    mesh.texture.insert(mesh.texture.end(), part.texture.begin(), part.texture.end());
  }
  mesh.vertex.insert(mesh.vertex.end(), part.vertex.begin(), part.vertex.end());
  mesh.normal.insert(mesh.normal.end(), part.normal.begin(), part.normal.end());
  mesh.albedo.insert(mesh.albedo.end(), part.albedo.begin(), part.albedo.end());
  for (const auto& t : part.triangle) mesh.triangle.push_back({t[0] + first, t[1] + first, t[2] + first});
  mesh.decal.insert(mesh.decal.end(), part.decal.begin(), part.decal.end());
}

void Move(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation, TriangleMesh& mesh) {
  for (Eigen::Vector3d& v : mesh.vertex) v = rotation * v + translation;
  for (Eigen::Vector3d& n : mesh.normal) n = rotation * n;
  for (Decal& decal : mesh.decal) {
    decal.origin = rotation * decal.origin + translation;
    decal.right = rotation * decal.right;
    decal.down = rotation * decal.down;
  }
}

Eigen::Matrix3d RotationFromPose(double yaw_deg, double pitch_deg, double roll_deg) {
  constexpr double kRad = std::numbers::pi / 180;
  return (Eigen::AngleAxisd(roll_deg * kRad, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(yaw_deg * kRad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(pitch_deg * kRad, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace striae::rig
