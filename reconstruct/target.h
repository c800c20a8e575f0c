// A printed label of known size, found under the stripes: its size in the photograph gives the distance.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "core/calibration.h"
#include "core/image.h"

namespace striae::reconstruct {

/// A label of core/target.h as one photograph shows it.
struct TargetSighting {
  int marker_id = 0;                         ///< in DICT_4X4_1000; whose session it is, the caller checks
  double side_mm = 0;                        ///< what it is taken to measure
  std::array<Eigen::Vector2d, 4> corner_px;  ///< sensor px: upper left, upper right, lower right, lower left as printed
  Eigen::Vector3d middle_mm = Eigen::Vector3d::Zero();  ///< of the label's plane, camera frame
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();     ///< unit, towards the camera
  double distance_sd_mm = 0;                            ///< standard uncertainty of the middle's depth
  double misfit_px = 0;                                 ///< rms between the corners and those of the posed square
};

/// Finds the largest label that is wholly visible. `background` is the photograph without its stripes (the local mean,
/// linear light, sensor orientation). The sides are straight lines through the half of the step from paper to ink, far
/// from the corners that the mean rounds; blur of the mean does not move them. nullopt when there is none, when a side
/// is hidden or bent (no plane fits), or when the print is mirrored.
std::optional<TargetSighting> FindTarget(const ImageF& background, const CameraModel& camera, double side_mm);

}  // namespace striae::reconstruct
