// A procedural bust: head, neck and torso; the head turns by a known rotation about a point in the neck.
#pragma once

#include "acquire/rig/mesh.h"

namespace striae::rig {

enum class Shirt { kNone, kPlain, kStriped, kDark };
enum class Hair { kNone, kShort, kLong };

struct BustOptions {
  double distance_mm = 2000;  ///< depth of the neck's pivot
  double pivot_y_mm = -55;    ///< its height: so high that the light's upper edge crosses the forehead
  Eigen::Matrix3d head_rotation =
      Eigen::Matrix3d::Identity();  ///< relative to the torso, camera axes of the neutral pose
  Eigen::Matrix3d torso_rotation = Eigen::Matrix3d::Identity();  ///< of the whole body about the pivot, camera axes
  Eigen::Vector3d torso_shift_mm = Eigen::Vector3d::Zero();      ///< of the whole body
  unsigned seed = 1;                                             ///< of the skin's mottling, and of the hair
  Shirt shirt = Shirt::kNone;  ///< striped: bands across, 14 mm each; dark: black cotton, no modulation
  Hair hair = Hair::kNone;     ///< dark locks of 1 to 2.6 mm; long: over the shoulders to the chest
  bool arm = false;            ///< the left forearm held before the chest: another surface before the torso
};

/// The bust in the camera frame, facing the camera. Head and torso are rigid, the neck bends between them. With T and
/// H the rotations of torso and head from the neutral pose, T^T H = head_rotation exactly.
TriangleMesh MakeBust(const BustOptions& options);

}  // namespace striae::rig
