// A printed label of known size, found under the stripes: its size in the photograph gives the distance.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "core/calibration.h"
#include "reconstruct/phase.h"

namespace striae::reconstruct {

/// normal . p = offset on the plane z = 1 (lens distortion removed), and how well its place is known there.
struct SideLine {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double offset = 0, sd = 0;
};

/// A label of core/target.h as one photograph shows it.
struct TargetSighting {
  int marker_id = 0;                         ///< in DICT_4X4_1000; whose session it is, the caller checks
  double side_mm = 0;                        ///< what it is taken to measure
  std::array<Eigen::Vector2d, 4> corner_px;  ///< sensor px: upper left, upper right, lower right, lower left as printed
  std::array<SideLine, 4> sides;             ///< from upper left to upper right, and on clockwise
  Eigen::Vector3d middle_mm = Eigen::Vector3d::Zero();  ///< of the label's plane, camera frame
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();     ///< unit, towards the camera
  double distance_sd_mm = 0;                            ///< standard uncertainty of the middle's depth
};

/// Finds the largest label that is wholly visible, on the photograph without its stripes (the local mean, sensor
/// orientation). Its sides are straight lines through the half of the step from paper to ink, far from the corners that
/// the mean rounds. A side along the stripes is known to a seventh of a stripe only, since no light falls on the dark
/// ones; one across the stripes to a third of a pixel. The pose weighs them so. nullopt when there is no label, when a
/// side is hidden or bent (no plane fits), or when the print is mirrored.
std::optional<TargetSighting> FindTarget(const PhaseResult& phase, const CameraModel& camera, double side_mm);

}  // namespace striae::reconstruct
