// The limb's crater by its formulas: coordinates, and integrals over the outline.
#pragma once

#include "acquire/rig/limb.h"

namespace striae::rig::detail {

/// Distance from the crater's middle relative to its outline in that direction: 1 on the outline.
double CraterRho(const LimbOptions& options, double angle_rad, double along_mm);

/// A point of the limb in its own frame: axis along y, angle 0 towards -z (the camera), positive angles to x.
Eigen::Vector3d LimbPoint(double angle_rad, double along_mm, double radius_mm);

/// Volume, areas, depth and outline (in the limb's frame) from the formulas.
WoundTruth IntegrateWound(const LimbOptions& options);

}  // namespace striae::rig::detail
