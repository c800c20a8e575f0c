// Which cells are sound ground for a stripe order: where no step of whole stripes can hide.
#pragma once

#include "reconstruct/detail/order_cells.h"

namespace striae::reconstruct::detail {

constexpr float kSureNoises = 4;  ///< by so many noises a valley or a bend must stand out

/// 1 where the cell is of a region and not in a valley of the stripes' amplitude.
Mask SoundCells(const Grid& grid, int reach_x, int reach_y);

/// Takes out the cells where the order is bent: the slope changes along the outline of what lies before. Or where it
/// jumps: over a third of a stripe along the stripes, where the window does not round it, and across them. `lag_x`,
/// `lag_y`: cells in two thirds of a stripe along the stripes, in a whole one across.
void TakeOutBends(const Grid& grid, int lag_x, int lag_y, bool horizontal, Mask& sound);

/// Cells with no unsound one, and no other region's, within the rectangle around them; beyond the picture is sound.
Mask Eroded(const Grid& grid, const Mask& sound, int reach_x, int reach_y);

}  // namespace striae::reconstruct::detail
