#include "core/optics.h"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace striae {
namespace {
constexpr int kUndistortIterations = 20;
constexpr int kDepthIterations = 8;
}  // namespace

Eigen::Vector2d Distort(const CameraModel& camera, const Eigen::Vector2d& u) {
  const double r2 = u.squaredNorm();
  const double radial = 1 + r2 * (camera.k1 + r2 * camera.k2);
  const double xy2 = 2 * u.x() * u.y();
  return {u.x() * radial + camera.p1 * xy2 + camera.p2 * (r2 + 2 * u.x() * u.x()),
          u.y() * radial + camera.p1 * (r2 + 2 * u.y() * u.y()) + camera.p2 * xy2};
}

Eigen::Vector2d Undistort(const CameraModel& camera, const Eigen::Vector2d& distorted) {
  Eigen::Vector2d u = distorted;
  for (int i = 0; i < kUndistortIterations; ++i) {
    const Eigen::Vector2d error = Distort(camera, u) - distorted;
    u -= error;
    if (error.squaredNorm() < 1e-28) break;
  }
  return u;
}

Eigen::Vector2d Project(const CameraModel& camera, const Eigen::Vector3d& point) {
  const Eigen::Vector2d d = Distort(camera, point.head<2>() / point.z());
  return {camera.fx * d.x() + camera.cx, camera.fy * d.y() + camera.cy};
}

Eigen::Vector3d RayOf(const CameraModel& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d u =
      Undistort(camera, {(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy});
  return {u.x(), u.y(), 1};
}

Eigen::Matrix3d RotationFromRodrigues(const Eigen::Vector3d& rodrigues) {
  const double angle = rodrigues.norm();
  if (angle < 1e-15) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rodrigues / angle).toRotationMatrix();
}

StripeOptics::StripeOptics(const Calibration& calibration)
    : projector_(calibration.projector),
      direction_(calibration.direction),
      projector_from_camera_(RotationFromRodrigues(projector_.rotation_rodrigues)),
      center_in_projector_(projector_from_camera_ * projector_.center_mm) {}

std::optional<double> StripeOptics::OrderAt(const Eigen::Vector3d& point) const {
  if (projector_.kind == ProjectorModel::Kind::kAngular) {
    const int axis = direction_ == StripeDirection::kHorizontal ? 1 : 0;
    const double along = point.z() - projector_.center_mm.z();
    if (along <= 0) return std::nullopt;
    const double angle = std::atan((point[axis] - projector_.center_mm[axis]) / along);
    return (angle - projector_.a0_rad) / projector_.delta_a_rad;
  }
  const Eigen::Vector3d q = projector_from_camera_ * (point - projector_.center_mm);
  if (q.z() <= 0) return std::nullopt;
  const double a = q.x() / q.z(), b = q.y() / q.z();
  const double m = 1 + projector_.k1 * (a * a + b * b);
  return projector_.center_order + projector_.focal_stripes * b * m;
}

std::optional<double> StripeOptics::PinholeDepth(const Eigen::Vector3d& ray, double order) const {
  const Eigen::Vector3d d = projector_from_camera_ * ray;
  const Eigen::Vector3d& c = center_in_projector_;
  const double distorted = (order - projector_.center_order) / projector_.focal_stripes;
  double b = distorted, z = 0;
  for (int i = 0; i < kDepthIterations; ++i) {
    const double previous = z;
    z = (c.y() - b * c.z()) / (d.y() - b * d.z());
    if (projector_.k1 == 0 || std::abs(z - previous) < 1e-9) break;
    const Eigen::Vector3d q = z * d - c;
    const double a = q.x() / q.z();
    b = distorted / (1 + projector_.k1 * (a * a + b * b));
  }
  if (!std::isfinite(z) || z <= 0 || (z * d - c).z() <= 0) return std::nullopt;
  return z;
}

std::optional<double> StripeOptics::AngularDepth(const Eigen::Vector3d& ray, double order) const {
  const int axis = direction_ == StripeDirection::kHorizontal ? 1 : 0;
  const double tangent = std::tan(projector_.a0_rad + order * projector_.delta_a_rad);
  // The paper's (4) with its axes upwards: P_y = -C.y, P_z = C.z, v_n = -y/z.
  const double z = (-projector_.center_mm[axis] + projector_.center_mm.z() * tangent) / (-ray[axis] + tangent);
  if (!std::isfinite(z) || z <= 0) return std::nullopt;
  return z;
}

std::optional<double> StripeOptics::DepthAt(const Eigen::Vector3d& ray, double order) const {
  return projector_.kind == ProjectorModel::Kind::kAngular ? AngularDepth(ray, order) : PinholeDepth(ray, order);
}

double StripeOptics::DepthPerStripe(const Eigen::Vector3d& ray, double depth_mm) const {
  const double step_mm = 1e-4 * depth_mm;
  const auto before = OrderAt((depth_mm - step_mm) * ray);
  const auto behind = OrderAt((depth_mm + step_mm) * ray);
  if (!before || !behind || *before == *behind) return std::numeric_limits<double>::infinity();
  return 2 * step_mm / (*behind - *before);
}

}  // namespace striae
