// The cells that a boundary is looked for in, with what tells wound from skin.
#pragma once

#include <array>
#include <vector>

#include "analysis/wound/boundary.h"
#include "analysis/wound/detail/grabcut.h"
#include "analysis/wound/detail/patch.h"

namespace striae::wound {

/// Cells with their features.
struct BoundaryField {
  Patch patch;
  std::vector<std::array<std::uint8_t, 3>> features;
  std::vector<Eigen::Vector3d> smooth;  ///< their means over three by three cells, for following the edge
  std::vector<CellClass> classes;
};

/// Cuts out the cells around the hints, takes their colours and depths, and marks what the hints say. Errors as
/// ProposeBoundary().
Result<BoundaryField> PrepareField(const Surface& surface, const BoundaryHints& hints, const BoundaryOptions& options,
                                   const ImageRgb* photograph);

}  // namespace striae::wound
