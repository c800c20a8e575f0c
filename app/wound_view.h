// A wound seen from the side: the shaded surface in its own colours, the boundary, and the virtual skin as a net over
// it.
#pragma once

#include "analysis/wound/wound.h"
#include "core/image.h"

namespace striae::app {

/// Parallel projection from 40 degrees above the skin, light from above left; 720 pixels wide on white. `colours` has
/// one pixel a cell of the maps. Depends on nothing but its arguments.
ImageRgb ViewOfWound(const wound::WoundMaps& maps, const ImageRgb& colours);

}  // namespace striae::app
