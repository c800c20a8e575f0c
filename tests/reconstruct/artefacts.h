// Surfaces of artefacts from geometry alone: what a camera of an eighth of the D90's sensor would see of them.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <random>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/surface.h"

namespace striae::testing {

/// Depth z along a ray (z = 1), or nothing.
using Shape = std::function<std::optional<double>(const Eigen::Vector3d& ray)>;

inline constexpr int kSensorWidth = 536, kSensorHeight = 356;
inline constexpr double kFocalPx = 1195;

inline Surface Seen(const std::vector<Shape>& shapes) {
  Surface surface;
  surface.sensor_width_px = kSensorWidth;
  surface.sensor_height_px = kSensorHeight;
  for (int row = 0; row < kSensorHeight; ++row) {
    for (int col = 0; col < kSensorWidth; ++col) {
      const Eigen::Vector3d ray((col - kSensorWidth / 2.0) / kFocalPx, (row - kSensorHeight / 2.0) / kFocalPx, 1);
      std::optional<double> nearest;
      for (const Shape& shape : shapes) {
        const auto depth = shape(ray);
        if (depth && (!nearest || *depth < *nearest)) nearest = depth;
      }
      if (!nearest) continue;
      surface.point_in_camera.push_back((*nearest * ray).cast<float>());
      surface.colour.push_back({200, 200, 200});
      surface.quality.push_back(0.8F);
      surface.col.push_back(static_cast<std::uint16_t>(col));
      surface.row.push_back(static_cast<std::uint16_t>(row));
    }
  }
  return surface;
}

/// A square plate of half side `half` about `centre`, turned by `tilt_rad` about y; `bump(u, v)` is its form in mm
/// along its normal at u, v in -1 .. 1.
inline Shape Plate(
    const Eigen::Vector3d& centre, double half, double tilt_rad,
    const std::function<double(double, double)>& bump = [](double, double) { return 0.0; }) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return [=](const Eigen::Vector3d& ray) -> std::optional<double> {
    const Eigen::Vector3d normal = -turn.col(2);
    double height = 0;
    Eigen::Vector2d place;
    double depth = 0;
    for (int round = 0; round < 6; ++round) {
      depth = (normal.dot(centre) + height) / normal.dot(ray);
      const Eigen::Vector3d at = turn.transpose() * (depth * ray - centre);
      place = at.head<2>() / half;
      height = bump(place.x(), place.y());
    }
    if (place.cwiseAbs().maxCoeff() > 1) return std::nullopt;
    return depth;
  };
}

/// A ball whose radius grows by `bump(phi)`, phi the angle about the direction to the camera.
inline Shape Ball(
    const Eigen::Vector3d& centre, double radius,
    const std::function<double(double)>& bump = [](double) { return 0.0; }) {
  return [=](const Eigen::Vector3d& ray) -> std::optional<double> {
    const Eigen::Vector3d direction = ray.normalized(), axis = centre.normalized();
    const Eigen::Vector3d right = Eigen::Vector3d::UnitY().cross(axis).normalized(), down = axis.cross(right);
    double r = radius;
    double along = 0;
    for (int round = 0; round < 8; ++round) {
      const double middle = direction.dot(centre);
      const double half = r * r - (centre.squaredNorm() - middle * middle);
      if (half < 0) return std::nullopt;
      along = middle - std::sqrt(half);
      const Eigen::Vector3d u = along * direction - centre;
      r = radius + bump(std::atan2(u.dot(down), u.dot(right)));
    }
    return along * direction.z();
  };
}

/// An upright cylinder: a limb.
inline Shape Limb(const Eigen::Vector3d& centre, double radius) {
  return [=](const Eigen::Vector3d& ray) -> std::optional<double> {
    const Eigen::Vector2d d(ray.x(), ray.z()), c(centre.x(), centre.z());
    const double a = d.squaredNorm(), b = d.dot(c), root = b * b - a * (c.squaredNorm() - radius * radius);
    if (root < 0) return std::nullopt;
    return (b - std::sqrt(root)) / a;
  };
}

/// Every point moved along its ray by normal noise of `sd_mm` in depth.
inline Surface WithNoise(Surface surface, double sd_mm, unsigned seed = 7) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, sd_mm);
  for (Eigen::Vector3f& p : surface.point_in_camera) p *= static_cast<float>(1 + noise(random) / p.z());
  return surface;
}

/// Keeps the points of which `keep(col, row)` is true.
inline Surface Only(const Surface& surface, const std::function<bool(int, int)>& keep) {
  Surface kept;
  kept.sensor_width_px = surface.sensor_width_px;
  kept.sensor_height_px = surface.sensor_height_px;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (!keep(surface.col[i], surface.row[i])) continue;
    kept.point_in_camera.push_back(surface.point_in_camera[i]);
    kept.colour.push_back(surface.colour[i]);
    kept.quality.push_back(surface.quality[i]);
    kept.col.push_back(surface.col[i]);
    kept.row.push_back(surface.row[i]);
  }
  return kept;
}

}  // namespace striae::testing
