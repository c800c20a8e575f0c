// Regions renumbered cell by cell.
#pragma once

#include <cstdint>
#include <vector>

#include "reconstruct/detail/order_parts.h"

namespace striae::reconstruct::detail {

/// Gives every pixel the label of the cell that it lies in, or of one beside it, among the labels of its own sheet; the
/// sheet's first label where there is none. Then numbers the labels by their pixels, largest first; empty ones last.
/// `cell_label`: of each of the grid's cells, kNone outside. `sheet_of_label`, `sheet_of_region`: the sheet of each
/// label and of each region that `phase` has now. Returns each label's new region.
std::vector<int> ApplyLabels(const Grid& grid, const Image<std::int32_t>& cell_label,
                             const std::vector<std::int32_t>& sheet_of_label,
                             const std::vector<std::int32_t>& sheet_of_region, PhaseResult& phase);

}  // namespace striae::reconstruct::detail
