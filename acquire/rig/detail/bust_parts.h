// The bust's parts in its own frame: origin at the neck's pivot, x to the subject's left (right in the image), y down,
// z backwards; made of smooth formulas, vertices about 1 mm apart.
#pragma once

#include "acquire/rig/mesh.h"

namespace striae::rig::detail {

TriangleMesh MakeHead(unsigned seed);
TriangleMesh MakeNeck(unsigned seed);
TriangleMesh MakeTorso(unsigned seed);

}  // namespace striae::rig::detail
