#include "analysis/head/angles.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include <Eigen/Geometry>

namespace striae::head {

Eigen::Matrix3d SubjectFromCamera(const Eigen::Vector3d& up_in_camera) {
  const Eigen::Vector3d towards_camera(0, 0, -1);
  const Eigen::Vector3d up = up_in_camera.normalized();
  if (!up.allFinite() || std::abs(up.dot(towards_camera)) > 0.87) {
    throw std::logic_error("SubjectFromCamera: up must not lie along the optical axis");
  }
  const Eigen::Vector3d forward = (towards_camera - up * up.dot(towards_camera)).normalized();
  Eigen::Matrix3d subject_from_camera;
  subject_from_camera << forward.transpose(), up.transpose(), forward.cross(up).transpose();
  return subject_from_camera;
}

HeadAngles Decompose(const Eigen::Matrix3d& r) {
  HeadAngles angles;
  angles.tilt = Angle::Radians(std::asin(std::clamp(r(2, 1), -1.0, 1.0)));
  angles.flexion = Angle::Radians(-std::atan2(-r(0, 1), r(1, 1)));
  angles.rotation = Angle::Radians(std::atan2(-r(2, 0), r(2, 2)));
  // acos alone loses half the digits near zero; the quaternion form does not.
  angles.total = Angle::Radians(Eigen::AngleAxisd(r).angle());
  return angles;
}

Eigen::Matrix3d Compose(const HeadAngles& angles) {
  return (Eigen::AngleAxisd(-angles.flexion.rad(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(angles.tilt.rad(), Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(angles.rotation.rad(), Eigen::Vector3d::UnitY()))
      .toRotationMatrix();
}

std::string InWords(const std::string& name, double degrees) {
  char number[32];
  std::snprintf(number, sizeof number, "%.1f deg", std::abs(degrees));
  const std::string amount = number;
  if (name == "total_angle") return "turned " + amount + " in all";
  const bool positive = degrees >= 0;
  if (amount == "0.0 deg") return name == "rotation" ? "not turned" : name == "tilt" ? "not tilted" : "not bent";
  if (name == "rotation") return "turned " + amount + " to the subject's " + (positive ? "left" : "right");
  if (name == "tilt") return "tilted " + amount + " to the subject's " + (positive ? "right" : "left");
  return positive ? "bent " + amount + " forward (chin towards the chest)" : "bent " + amount + " backward (chin up)";
}

}  // namespace striae::head
