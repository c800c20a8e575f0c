// The virtual rig's bodies: triangle meshes with normals for shading and an albedo at every vertex.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "core/image.h"

namespace striae::rig {

/// Something flat painted onto a surface: squares of grey, seen along the normal of a plane that touches it.
struct Decal {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();                                   ///< its middle, on the surface
  Eigen::Vector3d right = Eigen::Vector3d::UnitX(), down = Eigen::Vector3d::UnitY();  ///< unit, normal to each other
  double cell_mm = 1;
  int columns = 0, rows = 0;  ///< of cells
  std::vector<float> albedo;  ///< of each cell, linear, row by row from the upper left
  double reach_mm = 0;        ///< painted is what lies at most so far before or behind the plane
};

/// Vertices in mm, in the camera frame once the body is placed (x right, y down, z forward).
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertex;
  std::vector<Eigen::Vector3d> normal;  ///< unit, out of the body; used for shading only, the truth is the facets
  std::vector<Eigen::Vector3f> albedo;  ///< linear RGB, 0..1
  std::vector<std::array<std::uint32_t, 3>> triangle;    ///< counter-clockwise seen from outside
  std::vector<std::shared_ptr<const ImageRgb>> texture;  ///< sRGB pictures that multiply the albedo
  std::vector<Eigen::Vector2f> uv;                       ///< of every vertex: (0, 0) upper left, (1, 1) lower right of
                                                         ///< its picture, repeated beyond; empty without textures
  std::vector<int> texture_of_triangle;                  ///< index, -1 for none; empty without textures
  std::vector<Decal> decal;                              ///< painted over the albedo, the last one on top
};

/// Joins `columns` x `rows` vertices, stored row by row from index `first`, to triangles; `closed` also joins the last
/// column to the first. The outside is where columns run to the right and rows downwards.
void AppendGridTriangles(std::size_t first, int columns, int rows, bool closed, TriangleMesh& mesh);

/// Vertex normals as the sum of the adjoining facets' normals, weighted by area.
void ComputeNormals(TriangleMesh& mesh);

/// Adds the vertices, triangles and paint of `part`.
void Append(const TriangleMesh& part, TriangleMesh& mesh);

/// point -> rotation * point + translation, normals likewise.
void Move(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation, TriangleMesh& mesh);

/// Rotations about the camera's axes as the rig states poses: Rz(roll) Ry(yaw) Rx(pitch), degrees. For a subject who
/// looks at the camera: positive yaw turns to the subject's right, pitch lowers the chin, roll tilts to the left.
Eigen::Matrix3d RotationFromPose(double yaw_deg, double pitch_deg, double roll_deg);

}  // namespace striae::rig
