// Blocks of known heights on a plate: steps that cut the phase, and depth differences that a gauge could hold.
#pragma once

#include <vector>

#include "acquire/rig/mesh.h"
#include "core/result.h"

namespace striae::rig {

struct BlocksOptions {
  std::vector<double> heights_mm = {5, 10, 20, 40};  ///< above the plate, side by side from left to right
  double block_mm = 40;                              ///< side of each block's square face; as much lies between two
  double plate_width_mm = 420, plate_height_mm = 350;
  double albedo = 0.6;
};

/// Plate and blocks in their own frame: x right, y down, relief along -z, the plate's face in z = 0, centred on the
/// origin. Block i's face is the square of side block_mm about BlockCenter(i). kUsage for heights that are not
/// positive, none, or blocks that do not fit onto the plate.
Result<TriangleMesh> MakeBlocks(const BlocksOptions& options);
Eigen::Vector3d BlockCenter(const BlocksOptions& options, std::size_t i);

}  // namespace striae::rig
