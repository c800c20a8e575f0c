#include "reconstruct/calibrate/reference_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace striae::reconstruct {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
/// Beyond this slope a wall is a step: it is in shadow or smeared by the Fourier window.
constexpr double kSteepest = 1.2;
/// The Fourier window smears a step over about this many millimetres at 1 m; the mask keeps away as far.
constexpr double kStepMarginShare = 0.006;  // of the object's longer side

/// Writes the triangle's height to every grid node under it, the nearer to the camera (smaller z) winning.
void Rasterise(const Eigen::Vector3d (&corner)[3], const Eigen::Vector3d& lowest, double spacing, ImageF& height) {
  const auto column = [&](double x) { return (x - lowest.x()) / spacing; };
  const auto row = [&](double y) { return (y - lowest.y()) / spacing; };
  const auto [x0, x1] = std::minmax({corner[0].x(), corner[1].x(), corner[2].x()});
  const auto [y0, y1] = std::minmax({corner[0].y(), corner[1].y(), corner[2].y()});
  const Eigen::Vector2d a = corner[0].head<2>(), b = corner[1].head<2>() - a, c = corner[2].head<2>() - a;
  const double area = b.x() * c.y() - b.y() * c.x();
  if (std::abs(area) < 1e-12) return;
  constexpr double kRim = 1e-9;  // nodes exactly on an edge belong to both triangles
  for (int r = std::max(0, static_cast<int>(std::ceil(row(y0) - kRim))); r <= row(y1) + kRim && r < height.height();
       ++r) {
    for (int q = std::max(0, static_cast<int>(std::ceil(column(x0) - kRim)));
         q <= column(x1) + kRim && q < height.width(); ++q) {
      const Eigen::Vector2d p = Eigen::Vector2d(lowest.x() + q * spacing, lowest.y() + r * spacing) - a;
      const double u = (p.x() * c.y() - p.y() * c.x()) / area, v = (b.x() * p.y() - b.y() * p.x()) / area;
      if (u < -kRim || v < -kRim || u + v > 1 + kRim) continue;
      const double z = corner[0].z() + u * (corner[1].z() - corner[0].z()) + v * (corner[2].z() - corner[0].z());
      float& node = height(q, r);
      if (std::isnan(node) || z < node) node = static_cast<float>(z);
    }
  }
}

}  // namespace

Result<ReferenceShape> ReferenceShape::FromMesh(const Surface& mesh, int cells) {
  if (mesh.faces.empty()) return Fail(ErrorCode::kBadFile, "the reference mesh has no faces; export it with triangles");
  ReferenceShape shape;
  shape.lowest_.setConstant(std::numeric_limits<double>::max());
  shape.highest_ = -shape.lowest_;
  for (const auto& point : mesh.point_in_camera) {
    shape.lowest_ = shape.lowest_.cwiseMin(point.cast<double>());
    shape.highest_ = shape.highest_.cwiseMax(point.cast<double>());
  }
  const Eigen::Vector3d extent = shape.highest_ - shape.lowest_;
  const double side_mm = extent.head<2>().maxCoeff();
  if (extent.head<2>().minCoeff() < 10) {
    return Fail(ErrorCode::kBadFile, "the reference mesh is smaller than 10 mm; its unit must be mm");
  }
  if (extent.z() < 0.01 * side_mm) {
    return Fail(ErrorCode::kBadFile, "the reference mesh has no relief along z; a flat plate cannot calibrate the rig");
  }
  shape.spacing_mm_ = side_mm / cells;
  shape.height_ = ImageF(static_cast<int>(extent.x() / shape.spacing_mm_) + 1,
                         static_cast<int>(extent.y() / shape.spacing_mm_) + 1, kNone);
  for (const auto& face : mesh.faces) {
    const Eigen::Vector3d corner[3] = {mesh.point_in_camera[face[0]].cast<double>(),
                                       mesh.point_in_camera[face[1]].cast<double>(),
                                       mesh.point_in_camera[face[2]].cast<double>()};
    Rasterise(corner, shape.lowest_, shape.spacing_mm_, shape.height_);
  }
  shape.MarkSteps();
  return shape;
}

void ReferenceShape::MarkSteps() {
  const int width = height_.width(), height = height_.height();
  usable_ = Mask(width, height, 1);
  const double longer_mm = (highest_ - lowest_).head<2>().maxCoeff();
  const int margin = std::max(2, static_cast<int>(std::ceil(kStepMarginShare * longer_mm / spacing_mm_)));
  const auto steep = [&](int q, int r) {
    if (q + 1 >= width || r + 1 >= height) return true;
    const float here = height_(q, r), right = height_(q + 1, r), below = height_(q, r + 1);
    const bool gentle =
        std::abs(right - here) < kSteepest * spacing_mm_ && std::abs(below - here) < kSteepest * spacing_mm_;
    return !gentle;  // NaN counts as steep
  };
  for (int r = 0; r < height; ++r) {
    for (int q = 0; q < width; ++q) {
      if (!steep(q, r)) continue;
      for (int y = std::max(0, r - margin); y <= std::min(height - 1, r + margin); ++y) {
        std::fill(usable_.Row(y) + std::max(0, q - margin), usable_.Row(y) + std::min(width - 1, q + margin) + 1,
                  std::uint8_t{0});
      }
    }
  }
}

std::optional<ReferenceShape::Height> ReferenceShape::At(double x, double y) const {
  const double q = (x - lowest_.x()) / spacing_mm_, r = (y - lowest_.y()) / spacing_mm_;
  const int col = static_cast<int>(std::floor(q)), row = static_cast<int>(std::floor(r));
  if (col < 0 || row < 0 || col + 1 >= height_.width() || row + 1 >= height_.height()) return std::nullopt;
  const double u = q - col, v = r - row;
  const double z00 = height_(col, row), z10 = height_(col + 1, row), z01 = height_(col, row + 1),
               z11 = height_(col + 1, row + 1);
  Height at;
  at.z = (1 - v) * ((1 - u) * z00 + u * z10) + v * ((1 - u) * z01 + u * z11);
  if (std::isnan(at.z)) return std::nullopt;
  at.dz_dx = ((1 - v) * (z10 - z00) + v * (z11 - z01)) / spacing_mm_;
  at.dz_dy = ((1 - u) * (z01 - z00) + u * (z11 - z10)) / spacing_mm_;
  at.usable = usable_(col, row) != 0;
  return at;
}

}  // namespace striae::reconstruct
