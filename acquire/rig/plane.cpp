#include "acquire/rig/plane.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace striae::rig {
namespace {
constexpr int kPlaneVertices = 41;  // a plane needs no more; several keep Embree's boxes tight
}  // namespace

Eigen::Vector3d PlaneNormal(const PlaneOptions& options) {
  return RotationFromPose(options.tilt_y_deg, options.tilt_x_deg, 0) * Eigen::Vector3d(0, 0, -1);
}

TriangleMesh MakePlane(const PlaneOptions& options) {
  TriangleMesh mesh;
  for (int row = 0; row < kPlaneVertices; ++row) {
    for (int column = 0; column < kPlaneVertices; ++column) {
      const auto place = [&](int i) { return options.half_size_mm * (2.0 * i / (kPlaneVertices - 1) - 1); };
      mesh.vertex.emplace_back(place(column), place(row), 0);
      mesh.albedo.push_back(Eigen::Vector3f::Constant(static_cast<float>(options.albedo)));
    }
  }
  AppendGridTriangles(0, kPlaneVertices, kPlaneVertices, false, mesh);
  ComputeNormals(mesh);
  Move(RotationFromPose(options.tilt_y_deg, options.tilt_x_deg, 0), {0, 0, options.distance_mm}, mesh);
  return mesh;
}

TriangleMesh MakeReferencePlate(const ReferencePlateOptions& options) {
  const double pitch_x = options.width_mm / options.columns, pitch_y = options.height_mm / options.rows;
  if (2 * options.cap_radius_mm >= std::min(pitch_x, pitch_y)) {
    throw std::logic_error("MakeReferencePlate: caps touch; make them smaller or fewer");
  }
  const double h = options.cap_height_mm, r = options.cap_radius_mm;
  const double ball = (r * r + h * h) / (2 * h);
  const int columns = static_cast<int>(std::ceil(options.width_mm / options.spacing_mm)) + 1;
  const int rows = static_cast<int>(std::ceil(options.height_mm / options.spacing_mm)) + 1;
  TriangleMesh mesh;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double u = options.width_mm * column / (columns - 1), v = options.height_mm * row / (rows - 1);
      const double dx = std::fmod(u, pitch_x) - pitch_x / 2, dy = std::fmod(v, pitch_y) - pitch_y / 2;
      const double d2 = dx * dx + dy * dy;
      const double relief = d2 < r * r ? std::sqrt(ball * ball - d2) - (ball - h) : 0;
      mesh.vertex.emplace_back(u - options.width_mm / 2, v - options.height_mm / 2, -relief);
      mesh.albedo.push_back(Eigen::Vector3f::Constant(0.6F));
    }
  }
  AppendGridTriangles(0, columns, rows, false, mesh);
  ComputeNormals(mesh);
  return mesh;
}

}  // namespace striae::rig
