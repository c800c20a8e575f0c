// The colours of a patch's cells: of the surface, or of the photograph itself, which sees walls that the surface lacks.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "analysis/wound/detail/patch.h"
#include "core/image.h"

namespace striae::wound {

using CellColours = std::vector<std::array<std::uint8_t, 3>>;  ///< sRGB, row-major

/// Means of the surface's colours; black where the patch is missing.
CellColours ColoursOf(const Surface& surface, const Patch& patch);

/// Means of the photograph's light over each cell, brought to one luminance: the hue of a place is the same in bright
/// and dark stripes, and in shadow as far as it is lit at all.
CellColours HuesOf(const ImageRgb& photograph, const Patch& patch);

/// Where a surface lacks cells beside a wound, its wall was too steep or in shadow: missing cells within `reach_cells`
/// of cells deeper than `deep_mm` take the colour and depth of those, nearest first. Which they are.
std::vector<std::size_t> GiveToWound(const Patch& patch, double deep_mm, int reach_cells, std::vector<double>& depth_mm,
                                     CellColours& colours);

}  // namespace striae::wound
