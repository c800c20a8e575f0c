// Skin-like albedo: smooth value noise in space, the same on every machine.
#pragma once

#include <Eigen/Core>

namespace striae::rig::detail {

/// Smooth noise of the point in -1..1, one lattice cell a unit.
double ValueNoise(const Eigen::Vector3d& point, unsigned seed);

/// `base` (linear RGB) with mottling of about `amount` (relative) at scales of some 25, 8 and 2.5 mm.
Eigen::Vector3f Skin(const Eigen::Vector3d& base, const Eigen::Vector3d& point_mm, double amount, unsigned seed);

/// 0 below `from`, 1 above `to`, with vanishing first and second derivatives at both (either order of the limits).
double SmootherStep(double from, double to, double x);

}  // namespace striae::rig::detail
