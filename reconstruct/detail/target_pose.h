// Where a square of known size lies, from its four sides.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "reconstruct/target.h"

namespace striae::reconstruct::detail {

/// From upper left to upper right, and on clockwise.
using Sides = std::array<SideLine, 4>;
/// Upper left, upper right, lower right, lower left.
using SquareCorners = std::array<Eigen::Vector2d, 4>;

/// Where each side meets the one before; nullopt when they hardly cross.
std::optional<SquareCorners> CornersOf(const Sides& sides);

struct Pose {
  Eigen::Vector3d middle, normal;  ///< mm, camera frame; the normal is unit and faces the camera
  double depth_sd_mm = 0;          ///< standard uncertainty of the middle's depth
  double misfit = 0;               ///< rms of what is left between square and sides, in units of their sd
};

/// Starts from Collins and Bartoli's infinitesimal plane-based pose (International Journal of Computer Vision 109
/// (2014) 252) and fits the square's sides to the lines by weighted least squares. The perspective of a small label
/// hardly shows its tilt: it is expected to face the camera within some 30 degrees, unless its `normal` (unit, towards
/// the camera) is known from elsewhere. nullopt where no pose lies before
/// the camera.
std::optional<Pose> PoseOf(const Sides& sides, double side_mm,
                           const std::optional<Eigen::Vector3d>& normal = std::nullopt);

}  // namespace striae::reconstruct::detail
