// What a surface's comments say about the photograph that it was made from.
#pragma once

#include <optional>

#include "core/hex.h"
#include "core/surface.h"

namespace striae::wound {

/// From the comment "photograph sha256 ..."; nothing where there is none.
std::optional<Sha256> PhotographOf(const Surface& surface);
/// From the comment "carrier period px ...", sensor pixels a stripe; nothing where there is none.
std::optional<double> CarrierPeriodOf(const Surface& surface);

}  // namespace striae::wound
