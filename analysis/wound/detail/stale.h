// Which photograph a surface was made from, as its comments say.
#pragma once

#include <optional>

#include "core/hex.h"
#include "core/surface.h"

namespace striae::wound {

/// From the comment "photograph sha256 ..."; nothing where there is none.
std::optional<Sha256> PhotographOf(const Surface& surface);

}  // namespace striae::wound
