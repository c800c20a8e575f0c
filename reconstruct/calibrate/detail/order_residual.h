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
  double camera[6] = {};     ///< fy px, fx/fy, cx px, cy px, k1, k2
  double projector[9] = {};  ///< centre x, y, z mm; Rodrigues x, y, z; focal stripes; central order; k1
  double pose[6] = {};       ///< object to camera: Rodrigues x, y, z; translation x, y, z mm, at position 0
  double slide[2] = {};      ///< direction (x, y, 1), normalised
};

/// Height of the reference, continued flat beyond its border so that the residual stays continuous.
ReferenceShape::Height HeightOrBase(const ReferenceShape& shape, double x, double y);

/// Where a ray from `origin` along `direction` (object frame) meets the relief: the ray's parameter, by fixed point.
double MeetRelief(const ReferenceShape& shape, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

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
T OrderOf(const T* projector, const T* point) {
  const T moved[3] = {point[0] - projector[0], point[1] - projector[1], point[2] - projector[2]};
  T q[3];
  ceres::AngleAxisRotatePoint(projector + 3, moved, q);
  const T a = q[0] / q[2], b = q[1] / q[2];
  return projector[7] + projector[6] * b * (1.0 + projector[8] * (a * a + b * b));
}

class OrderResidual {
 public:
  OrderResidual(const ReferenceShape& shape, const Eigen::Vector2d& pixel, double order, double position_mm,
                double sigma_stripes)
      : shape_(shape), pixel_(pixel), order_(order), position_mm_(position_mm), sigma_(sigma_stripes) {}

  template <typename T>
  bool operator()(const T* camera, const T* projector, const T* pose, const T* slide, const T* offset,
                  T* residual) const {
    T point[3];
    PointOnReference(camera, pose, slide, point);
    residual[0] = (order_ + offset[0] - OrderOf(projector, point)) / sigma_;
    return true;
  }

  /// Point in the camera frame where the pixel's ray meets the reference.
  template <typename T>
  void PointOnReference(const T* camera, const T* pose, const T* slide, T* point) const {
    T ray[3];
    UndistortedRay(camera, pixel_, ray);
    const T norm = sqrt(slide[0] * slide[0] + slide[1] * slide[1] + 1.0);
    const T origin_in_camera[3] = {-(pose[3] + position_mm_ * slide[0] / norm),
                                   -(pose[4] + position_mm_ * slide[1] / norm), -(pose[5] + position_mm_ / norm)};
    const T inverse[3] = {-pose[0], -pose[1], -pose[2]};
    T origin[3], direction[3];
    ceres::AngleAxisRotatePoint(inverse, origin_in_camera, origin);
    ceres::AngleAxisRotatePoint(inverse, ray, direction);
    const T depth = DepthOnReference(origin, direction);
    for (int i = 0; i < 3; ++i) point[i] = depth * ray[i];
  }

 private:
  template <typename T>
  T DepthOnReference(const T* origin, const T* direction) const {
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
    const double t = MeetRelief(shape_, o, d);
    const Eigen::Vector3d p = o + t * d;
    const auto h = HeightOrBase(shape_, p.x(), p.y());
    const T gap = (origin[2] + t * direction[2]) - h.z - h.dz_dx * (origin[0] + t * direction[0] - p.x()) -
                  h.dz_dy * (origin[1] + t * direction[1] - p.y());
    return t - gap / (d.z() - h.dz_dx * d.x() - h.dz_dy * d.y());
  }

  const ReferenceShape& shape_;
  Eigen::Vector2d pixel_;
  double order_, position_mm_, sigma_;
};

}  // namespace striae::reconstruct::detail
