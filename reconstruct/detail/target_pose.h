// Where a square of known size lies, from its four corners.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

namespace striae::reconstruct::detail {

/// Corners on the plane z = 1 (lens distortion removed): upper left, upper right, lower right, lower left.
using SquareCorners = std::array<Eigen::Vector2d, 4>;

struct Pose {
  Eigen::Vector3d middle, normal;  ///< mm, camera frame; the normal is unit and faces the camera
  double misfit = 0;               ///< rms of the corners on the plane z = 1
};

/// Collins and Bartoli's infinitesimal plane-based pose (International Journal of Computer Vision 109 (2014) 252),
/// refined by least squares; of its two tilts the one that fits better. nullopt where no pose lies before the camera.
std::optional<Pose> PoseOf(const SquareCorners& corners, double side_mm);

/// The depth's standard uncertainty from that of each corner's coordinates, by moving each a little.
double DepthUncertainty(const SquareCorners& corners, double side_mm, const Pose& pose, double corner_sd);

}  // namespace striae::reconstruct::detail
