// The volume between two sheets over one triangulation, by CGAL (the only file that includes it is closed_volume.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"

namespace striae::wound {

/// Measured bed and virtual skin at the same grid points, counter-clockwise seen from above (the skin's side). The
/// triangulation must be an edge-manifold disc (holes allowed, no corner-touching parts).
struct SheetPair {
  std::vector<Eigen::Vector3d> bed, skin;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Volume (mm3) under the skin and above the bed, net: where the bed rises above the skin it counts negative. Closes
/// the pair by a side wall and takes Polygon_mesh_processing::volume. kInternal when the mesh cannot be closed.
Result<double> VolumeBetween(const SheetPair& pair);

}  // namespace striae::wound
