#pragma once

#include <cstdint>
#include <span>

#include "acquire/structure.h"

namespace striae::acquire::detail {

/// TIFF 6.0 with SubIFDs; `bytes` begin with a TIFF header.
Result<FileStructure> CheckNef(std::span<const std::uint8_t> bytes);

}  // namespace striae::acquire::detail
