// What a surface's comments say about the photograph that it was made from.
#pragma once

#include <optional>
#include <string>

#include "core/hex.h"
#include "core/surface.h"

namespace striae {

/// The comment that names the photograph.
std::string PhotographComment(const Sha256& photograph);
/// From that comment; nothing where there is none.
std::optional<Sha256> PhotographOf(const Surface& surface);
/// From the comment "carrier period px ...", sensor pixels a stripe; nothing where there is none.
std::optional<double> CarrierPeriodOf(const Surface& surface);

}  // namespace striae
