#pragma once

#include <cstddef>
#include <cstdint>

/// Aborts when reading any bytes breaks a promise of acquire/structure.h or acquire/metadata.h.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
