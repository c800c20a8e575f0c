// Parts between which light leaves no room for a step.
#pragma once

#include <cstdint>
#include <vector>

#include "reconstruct/detail/order_links.h"

namespace striae::reconstruct::detail {

/// For each part the least part that it is one with: each of two parts is shown not to be farther than the other, by a
/// chain of parts of one sheet where light goes on. The lines of parts that are one count together.
std::vector<std::int32_t> MergedParts(const std::vector<std::int32_t>& sheet_of_part, const std::vector<Link>& links);

}  // namespace striae::reconstruct::detail
