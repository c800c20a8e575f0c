// Finds head and torso of a person who faces the camera, in the neutral capture only.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "analysis/head/detail/cloud.h"
#include "analysis/head/regions.h"
#include "core/result.h"

namespace striae::head::detail {

/// Indices into the cloud. Both patches leave out what moves on its own: mouth, jaw, neck, shoulders, arms.
struct Segmentation {
  std::vector<std::uint32_t> head, torso;
  Eigen::Vector3d neck_in_camera;  ///< about the middle of the neck, behind its skin
  // Heights along the subject's up axis and the head's width, mm, for the report.
  double top_mm = 0, chin_mm = 0, neck_mm = 0, shoulder_mm = 0, head_width_mm = 0;
  bool with_jaw = false;  ///< hair hides so much of the upper face that mouth and jaw are taken as well
  double nose_mm = 0;     ///< how far the midline of the face stands out from what lies 30 mm beside it
};

/// From the silhouette and the midline's profile; the head ends above the mouth.
/// Regions that an operator drew are taken instead (points inside, less what is seen at grazing or very uncertain).
/// kMeasurementRefused with what to do where head, face or torso does not show; kUsage for regions on a cloud without
/// pixels.
Result<Segmentation> Segment(const Cloud& cloud, const Eigen::Matrix3d& subject_from_camera, const Regions& drawn = {});

/// The convex hull of the points' pixels, whole pixels: what is shown to the operator, and can be corrected.
std::vector<Eigen::Vector2d> HullOf(const Cloud& cloud, const std::vector<std::uint32_t>& indices);

}  // namespace striae::head::detail
