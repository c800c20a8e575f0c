// Finds head and torso of a person who faces the camera, in the neutral capture only.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "analysis/head/detail/cloud.h"
#include "core/result.h"

namespace striae::head::detail {

/// Indices into the cloud. Both patches leave out what moves on its own: hair top, ears, jaw, neck, shoulders, arms.
struct Segmentation {
  std::vector<std::uint32_t> head, torso;
  Eigen::Vector3d neck_in_camera;  ///< about the middle of the neck, behind its skin
  // Heights along the subject's up axis and the head's width, mm, for the report.
  double top_mm = 0, neck_mm = 0, shoulder_mm = 0, head_width_mm = 0;
};

/// The silhouette's width along the up axis, followed from the top: head, its narrowing at the neck, shoulders.
/// kMeasurementRefused with what to do where one of them does not show.
Result<Segmentation> Segment(const Cloud& cloud, const Eigen::Matrix3d& subject_from_camera);

}  // namespace striae::head::detail
