// What covers the bust: shirt, hair, and an arm held before the chest. All in the bust's own frame (bust_parts.h).
#pragma once

#include "acquire/rig/bust.h"

namespace striae::rig::detail {

/// Colours the torso below the collar as cloth.
void PutOnShirt(Shirt shirt, unsigned seed, TriangleMesh& torso);

/// Darkens the scalp and returns the locks that grow on it; both turn with the head.
TriangleMesh GrowHair(Hair hair, unsigned seed, TriangleMesh& head);

/// The subject's left arm, bent, its forearm across the chest with some 80 mm of air behind it.
TriangleMesh MakeArm(unsigned seed);

}  // namespace striae::rig::detail
