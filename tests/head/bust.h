// A procedural person from the waist up: every pose is known because the shape is a formula, not a measurement.
#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/surface.h"

namespace striae::testing {

/// Subject frame: X forward, Y up, Z right; origin between the shoulders at the base of the neck; mm.
struct Bust {
  Eigen::Matrix3d head_rotation = Eigen::Matrix3d::Identity();     ///< in subject axes, about the middle of the neck
  Eigen::Isometry3d torso_motion = Eigen::Isometry3d::Identity();  ///< of the whole body, in subject axes
  bool with_head = true;
  bool ball_for_head = false;  ///< a sphere on a neck: its rotation cannot be seen
  double jaw_drop_mm = 0;      ///< expression: what moves on its own
  double breath_mm = 0;        ///< the chest's rise
  double shrug_mm = 0;         ///< the shoulders' rise
};

/// Signed distance (a lower bound of its size outside) of a point in subject axes.
double DistanceTo(const Bust& bust, const Eigen::Vector3d& point);

/// The side that a camera sees from `distance_mm` in front: one vertex for each pixel of a small sensor whose ray
/// meets the body, with Gaussian noise along the ray. x right, y down, z forward.
Surface SeenFromTheFront(const Bust& bust, double noise_mm, std::uint32_t seed, double distance_mm = 2000);

/// A sphere of that radius seen by the same camera.
Surface SphereSeenFromTheFront(double radius_mm, double noise_mm, std::uint32_t seed);

/// Takes subject axes to camera axes, by hand: forward is towards the camera, up is against y, right is against x.
Eigen::Matrix3d CameraFromSubject();

}  // namespace striae::testing
