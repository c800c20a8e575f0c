// Surface <-> binary STL (triangles alone: no colour, no pixels). Pure: bytes in, bytes out.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "core/surface.h"

namespace striae {

/// 50 bytes a triangle, normal by the right-hand rule (towards the camera). The 80-byte header holds `header` cut to 79
/// characters and never starts with "solid", which would make readers take it for the ascii form.
std::vector<std::uint8_t> EncodeStl(const Surface& surface, std::string_view header);

/// Vertices at the same place become one; grey, quality 1, no pixels. kBadFile for the ascii form, a size that is not
/// the number of triangles' and a coordinate that is not finite.
Result<Surface> DecodeStl(std::span<const std::uint8_t> bytes);

}  // namespace striae
