// A ball, as VDI/VDE 2634 part 2 uses it to check form, size and distance.
#pragma once

#include "acquire/rig/mesh.h"
#include "core/result.h"

namespace striae::rig {

struct BallOptions {
  Eigen::Vector3d center_mm = {0, 0, 1075};  ///< camera frame
  double radius_mm = 75;
  double albedo = 0.6;
};

/// Its facets lie within 1e-5 of the radius of the sphere. kUsage for a radius that is not positive, or a ball that
/// reaches the camera.
Result<TriangleMesh> MakeBall(const BallOptions& options);

}  // namespace striae::rig
