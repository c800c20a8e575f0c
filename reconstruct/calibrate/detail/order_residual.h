// The residual of one phase sample, in stripes: measured order + the photograph's offset - the order that the projector
// gives to the point where the pixel's ray meets the posed reference. Nothing is triangulated, so it is smooth.
#pragma once

#include <cmath>

#include <ceres/rotation.h>

#include "core/optics.h"
#include "reconstruct/calibrate/reference_shape.h"

namespace striae::reconstruct::detail {

/// Layout of the parameter blocks.
struct RigParameters {
  double camera[6] = {};  ///< fy px, fx/fy, cx px, cy px, k1, k2
  /// Centre x, y, z mm; Rodrigues x, y, z; focal stripes; central order; k1. The angular model has the same places:
  /// [6] is orders per radian (1 / delta_a), [7] the order at angle 0 (-a0 / delta_a); rotation and k1 stay as they
  /// are.
  double projector[9] = {};
  double pose[6] = {};   ///< object to camera: Rodrigues x, y, z; translation x, y, z mm, at position 0
  double slide[2] = {};  ///< direction (x, y, 1), normalised
};

/// Which law gives the order of a point.
struct ProjectorLaw {
  ProjectorModel::Kind kind = ProjectorModel::Kind::kPinhole;
  int axis = 1;  ///< across the stripes in the camera frame (angular only)
};

/// Height of the reference, continued flat beyond its border so that the residual stays continuous.
ReferenceShape::Height HeightOrBase(const ReferenceShape& shape, double x, double y);

/// Where a ray from `origin` along `direction` (object frame) meets the relief: the ray's parameter, by Newton's method
/// from the relief's base or from `start` (near it).
double MeetRelief(const ReferenceShape& shape, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                  std::optional<double> start = {});

/// Undistorted x/z, y/z of a pixel: solved in doubles, then one Newton step in T, which makes the first derivatives
/// exact (implicit function theorem).
template <typename T>
void UndistortedRay(const T* camera, const Eigen::Vector2d& pixel, T* ray) {
  const auto value = [](const T& t) {
    if constexpr (std::is_same_v<T, double>) {
      return t;
    } else {
      return t.a;
    }
  };
  CameraModel model;
  model.fy = value(camera[0]);
  model.fx = value(camera[0]) * value(camera[1]);
  model.cx = value(camera[2]);
  model.cy = value(camera[3]);
  model.k1 = value(camera[4]);
  model.k2 = value(camera[5]);
  const Eigen::Vector3d start = RayOf(model, pixel);
  const double x = start.x(), y = start.y(), r2 = x * x + y * y;
  const T radial = 1.0 + r2 * (camera[4] + r2 * camera[5]);
  const T error_x = x * radial - (pixel.x() - camera[2]) / (camera[0] * camera[1]);
  const T error_y = y * radial - (pixel.y() - camera[3]) / camera[0];
  const double radial0 = value(radial), slope = 2 * (model.k1 + 2 * model.k2 * r2);
  const double jxx = radial0 + slope * x * x, jxy = slope * x * y, jyy = radial0 + slope * y * y;
  const double determinant = jxx * jyy - jxy * jxy;
  ray[0] = x - (jyy * error_x - jxy * error_y) / determinant;
  ray[1] = y - (jxx * error_y - jxy * error_x) / determinant;
  ray[2] = T(1.0);
}

template <typename T>
T OrderOf(const ProjectorLaw& law, const T* projector, const T* point) {
  const T moved[3] = {point[0] - projector[0], point[1] - projector[1], point[2] - projector[2]};
  if (law.kind == ProjectorModel::Kind::kAngular) {
    using std::atan;
    return projector[7] + projector[6] * atan(moved[law.axis] / moved[2]);
  }
  T q[3];
  ceres::AngleAxisRotatePoint(projector + 3, moved, q);
  const T a = q[0] / q[2], b = q[1] / q[2];
  return projector[7] + projector[6] * b * (1.0 + projector[8] * (a * a + b * b));
}

/// Point in the camera frame where a pixel's ray meets the posed reference.
template <typename T>
class RayOnReference {
 public:
  RayOnReference(const ReferenceShape& shape, const T* pose, const T* slide) : shape_(shape), pose_(pose) {
    const T norm = sqrt(slide[0] * slide[0] + slide[1] * slide[1] + 1.0);
    for (int i = 0; i < 2; ++i) slide_[i] = slide[i] / norm;
    slide_[2] = 1.0 / norm;
    for (int i = 0; i < 3; ++i) inverse_[i] = -pose[i];
  }

  /// Returns the reference's height there, for whether it may be used.
  ReferenceShape::Height operator()(const T* camera, const Eigen::Vector2d& pixel, double position_mm, T* point) const {
    T ray[3];
    UndistortedRay(camera, pixel, ray);
    T origin_in_camera[3], origin[3], direction[3];
    for (int i = 0; i < 3; ++i) origin_in_camera[i] = -(pose_[3 + i] + position_mm * slide_[i]);
    ceres::AngleAxisRotatePoint(inverse_, origin_in_camera, origin);
    ceres::AngleAxisRotatePoint(inverse_, ray, direction);
    Eigen::Vector3d o, d;
    for (int i = 0; i < 3; ++i) {
      if constexpr (std::is_same_v<T, double>) {
        o[i] = origin[i];
        d[i] = direction[i];
      } else {
        o[i] = origin[i].a;
        d[i] = direction[i].a;
      }
    }
    // One Newton step in T from the meeting found in doubles: exact first derivatives.
    const double t = MeetRelief(shape_, o, d);
    const Eigen::Vector3d p = o + t * d;
    const auto h = HeightOrBase(shape_, p.x(), p.y());
    const T gap = (origin[2] + t * direction[2]) - h.z - h.dz_dx * (origin[0] + t * direction[0] - p.x()) -
                  h.dz_dy * (origin[1] + t * direction[1] - p.y());
    const T depth = t - gap / (d.z() - h.dz_dx * d.x() - h.dz_dy * d.y());
    for (int i = 0; i < 3; ++i) point[i] = depth * ray[i];
    return h;
  }

 private:
  const ReferenceShape& shape_;
  const T* pose_;
  T slide_[3], inverse_[3];
};

}  // namespace striae::reconstruct::detail
