#pragma once

#include <cstdint>
#include <span>

#include "acquire/structure.h"

namespace striae::acquire::detail {

/// ITU-T T.81 annex B; `bytes` begin with SOI.
Result<FileStructure> CheckJpeg(std::span<const std::uint8_t> bytes);

}  // namespace striae::acquire::detail
