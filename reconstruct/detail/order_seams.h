// What is doubted after the whole numbers are settled: seams between surfaces, and what casts an impossible shadow.
#pragma once

#include <cstdint>
#include <vector>

#include "reconstruct/detail/order_links.h"
#include "reconstruct/order.h"

namespace striae::reconstruct::detail {

/// Cells with their labels, and each label's sheet and order. New labels are added at the end.
struct LabelledCells {
  const Grid& grid;
  Image<std::int32_t>& label;  ///< of each cell, kNone outside
  std::vector<std::int32_t>& sheet_of_label;
  std::vector<RegionOrder>& orders;  ///< of each label
};

/// The window mixes both surfaces where they meet, and no cell knows to which one it belongs: within a stripe of a
/// doubtful label of the same sheet (`warned`, by label) a cell is doubtful too; between two sure ones it becomes a
/// label of its own, with a warning.
void GiveSeams(const std::vector<bool>& warned, LabelledCells& cells);

/// Where a shadow says another number than the one found, what casts it becomes a label of its own with a warning,
/// along the lines that the shadow crosses. `away`: see ReadLighting. Whether any is.
bool DoubtShadows(const std::vector<Gap>& gaps, int away, bool horizontal, LabelledCells& cells);

}  // namespace striae::reconstruct::detail
