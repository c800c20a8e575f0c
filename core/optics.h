// The optics of the rig: camera rays, projector stripe order, and their intersection (OPTICS; double precision).
// Frames: camera: origin at the centre of projection, x right, y down, z forward. Lengths mm, angles rad.
#pragma once

#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "core/calibration.h"

namespace striae {

/// OpenCV's distortion of normalised coordinates (x/z, y/z): undistorted to distorted.
Eigen::Vector2d Distort(const CameraModel& camera, const Eigen::Vector2d& undistorted);
/// The inverse by Newton-like fixed-point iteration, to 1e-12 within the D90's field.
Eigen::Vector2d Undistort(const CameraModel& camera, const Eigen::Vector2d& distorted);
/// Where a point before the camera (z > 0) falls on the sensor, px.
Eigen::Vector2d Project(const CameraModel& camera, const Eigen::Vector3d& point_in_camera);
/// The ray of a sensor position, scaled to z = 1: point = z * ray.
Eigen::Vector3d RayOf(const CameraModel& camera, const Eigen::Vector2d& pixel);

/// Rotation matrix of a Rodrigues vector (angle = norm, axis = direction).
Eigen::Matrix3d RotationFromRodrigues(const Eigen::Vector3d& rodrigues);

/// Stripe order from geometry, and depth from stripe order. Precomputes what one photograph shares.
class StripeOptics {
 public:
  explicit StripeOptics(const Calibration& calibration);

  /// Stripe order n that lights a point (n is whole at the centre of a bright stripe); nullopt behind the projector.
  [[nodiscard]] std::optional<double> OrderAt(const Eigen::Vector3d& point_in_camera) const;
  /// Depth z (mm) where the ray (z = 1) meets the light sheet of order n; nullopt where they do not meet before the
  /// camera. Pinhole: a plane through the projector's centre, bent by its k1 (iterated). Angular: the paper's (4), (5).
  [[nodiscard]] std::optional<double> DepthAt(const Eigen::Vector3d& ray, double order) const;
  /// The same for a row of `count` pixels whose rays are (ray_x, ray_y, 1): depth and dz/dn (mm per stripe). NaN where
  /// DepthAt has no answer and where the order is NaN.
  void DepthsAt(std::size_t count, const double* ray_x, const double* ray_y, const float* order, double* depth_mm,
                double* depth_per_stripe) const;
  /// dz/dn at that depth along the ray, mm per stripe.
  [[nodiscard]] double DepthPerStripe(const Eigen::Vector3d& ray, double depth_mm) const;

 private:
  [[nodiscard]] std::optional<double> PinholeDepth(const Eigen::Vector3d& ray, double order) const;
  [[nodiscard]] std::optional<double> AngularDepth(const Eigen::Vector3d& ray, double order) const;

  ProjectorModel projector_;
  StripeDirection direction_;
  Eigen::Matrix3d projector_from_camera_;
  Eigen::Vector3d center_in_projector_;  ///< rotation times centre
};

}  // namespace striae
