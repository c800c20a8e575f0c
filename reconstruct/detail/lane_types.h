// One value of every lane in one vector. Included by the few files that work on whole vectors, and by no header.
#pragma once

#include <cstddef>
#include <cstdint>

#include "reconstruct/detail/line_block.h"

namespace striae::reconstruct::detail {

constexpr std::size_t At(int position) { return static_cast<std::size_t>(position) * kLanes; }

// One value of every lane (GCC's and clang's vector types: arithmetic is by lane, a comparison gives 0 or -1).
using Floats = float __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));
using Ints = std::int32_t __attribute__((vector_size(4 * kLanes)));
using Shorts = std::uint16_t __attribute__((vector_size(2 * kLanes), aligned(2), may_alias));
using Bytes = std::uint8_t __attribute__((vector_size(kLanes), aligned(1), may_alias));

// g++ warns that such a value would be returned otherwise with wider vectors; the only function that does is inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

#define STRIAE_LANES(type, pointer) (*reinterpret_cast<type*>(pointer))

}  // namespace striae::reconstruct::detail
