#include "core/optics.h"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "core/vector.h"

namespace striae {
namespace {
constexpr int kUndistortIterations = 20;
constexpr int kDepthIterations = 8;

/// What a row of pixels shares: the projector in its own frame.
struct PinholeRow {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d center;
  double focal, center_order, k1;
};

/// PinholeDepth for many pixels at once. The distortion is undone in a fixed number of steps, each of which makes the
/// error smaller by k1 (a^2 + b^2), a thousandth on these rigs.
STRIAE_VECTORISED void PinholeDepths(const PinholeRow& projector, std::size_t count, const double* __restrict ray_x,
                                     const double* __restrict ray_y, const float* __restrict order,
                                     double* __restrict depth_mm, double* __restrict depth_per_stripe) {
  constexpr int kSteps = 4;
  const Eigen::Matrix3d& r = projector.rotation;
  const double r00 = r(0, 0), r01 = r(0, 1), r02 = r(0, 2), r10 = r(1, 0), r11 = r(1, 1), r12 = r(1, 2);
  const double r20 = r(2, 0), r21 = r(2, 1), r22 = r(2, 2);
  const double cx = projector.center.x(), cy = projector.center.y(), cz = projector.center.z();
  const double focal = projector.focal, center_order = projector.center_order, k1 = projector.k1;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < count; ++i) {
    const double x = ray_x[i], y = ray_y[i];
    const double dx = r00 * x + r01 * y + r02, dy = r10 * x + r11 * y + r12, dz = r20 * x + r21 * y + r22;
    const double distorted = (static_cast<double>(order[i]) - center_order) / focal;
    double b = distorted, m = 1;
    for (int step = 1; step < kSteps; ++step) {
      const double z = (cy - b * cz) / (dy - b * dz);
      const double a = (z * dx - cx) / (z * dz - cz);
      m = 1 + k1 * (a * a + b * b);
      b = distorted / m;
    }
    const double across = dy - b * dz, z = (cy - b * cz) / across;
    // dz/db of the quotient; db/dn = 1 / (F m), where m is as good as constant.
    depth_per_stripe[i] = (z * dz - cz) / across / (focal * m);
    depth_mm[i] = (z > 0) & (z * dz > cz) ? z : kNone;
  }
}
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

void StripeOptics::DepthsAt(std::size_t count, const double* ray_x, const double* ray_y, const float* order,
                            double* depth_mm, double* depth_per_stripe) const {
  if (projector_.kind == ProjectorModel::Kind::kPinhole) {
    PinholeDepths({projector_from_camera_, center_in_projector_, projector_.focal_stripes, projector_.center_order,
                   projector_.k1},
                  count, ray_x, ray_y, order, depth_mm, depth_per_stripe);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d ray(ray_x[i], ray_y[i], 1);
    const auto z = AngularDepth(ray, static_cast<double>(order[i]));
    depth_mm[i] = z.value_or(std::numeric_limits<double>::quiet_NaN());
    depth_per_stripe[i] = z ? DepthPerStripe(ray, *z) : std::numeric_limits<double>::quiet_NaN();
  }
}

double StripeOptics::DepthPerStripe(const Eigen::Vector3d& ray, double depth_mm) const {
  const double step_mm = 1e-4 * depth_mm;
  const auto before = OrderAt((depth_mm - step_mm) * ray);
  const auto behind = OrderAt((depth_mm + step_mm) * ray);
  if (!before || !behind || *before == *behind) return std::numeric_limits<double>::infinity();
  return 2 * step_mm / (*behind - *before);
}

}  // namespace striae
