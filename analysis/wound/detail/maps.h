// What pictures of a wound are drawn from.
#pragma once

#include "analysis/wound/detail/quantities.h"
#include "analysis/wound/wound.h"

namespace striae::wound {

/// Depths of all cells within `reach_mm` of the line and the sections along and across the longest axis, which run
/// `beyond_mm` past the line.
WoundMaps DrawMaps(const Scene& scene, const Skin& skin, const Boundary& boundary, double reach_mm, double beyond_mm);

}  // namespace striae::wound
