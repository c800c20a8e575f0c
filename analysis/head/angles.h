// A head's rotation against the torso as the three clinical angles, after ISB (Wu et al. 2005, J. Biomech. 38:981).
//
// Subject axes: X forward, Y up, Z to the subject's right. Sequence Z-X-Y, intrinsic:
//   R = Rz(extension) Rx(tilt) Ry(rotation),  flexion = -extension.
#pragma once

#include <string>

#include <Eigen/Core>

#include "core/units.h"

namespace striae::head {

/// Signs: rotation positive to the subject's left, flexion positive chin towards the chest, tilt positive towards the
/// subject's right shoulder. `total` = acos((trace R - 1) / 2), free of any sequence, 0..180 deg.
struct HeadAngles {
  Angle rotation, flexion, tilt, total;
};

/// Takes camera coordinates (x right, y down, z away) to the axes of a subject who faces the camera; proper rotation.
/// `up_in_camera` is where the subject's head points (unit length): (0, -1, 0) for a camera held level. Throws
/// std::logic_error if it lies within 30 degrees of the optical axis.
Eigen::Matrix3d SubjectFromCamera(const Eigen::Vector3d& up_in_camera);

/// Angles of a rotation given in subject axes. Beyond a tilt of 80 degrees rotation and flexion trade places freely
/// (singular at 90): the matrix is the result there.
HeadAngles Decompose(const Eigen::Matrix3d& rotation_in_subject);

/// The inverse of Decompose; `total` is not read.
Eigen::Matrix3d Compose(const HeadAngles& angles);

/// One angle in words: "turned 32.1 deg to the subject's left". `name` is rotation, flexion, tilt or total_angle.
std::string InWords(const std::string& name, double degrees);

}  // namespace striae::head
