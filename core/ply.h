// Surface <-> binary little-endian PLY, and surface -> binary STL. Pure: bytes in, bytes out.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/surface.h"

namespace striae {

/// Vertex element first (float x y z, uchar red green blue, float quality, ushort col row), then faces.
/// The sensor's size and the surface's comments go into comment lines.
std::vector<std::uint8_t> EncodePly(const Surface& surface);

/// Reads any binary little-endian or ascii PLY with x, y, z; the other properties are optional and of any scalar
/// type. Without "striae sensor" comment the sensor size is the largest col and row + 1. kBadFile when truncated,
/// big-endian, an index is out of range, or a coordinate is not finite.
Result<Surface> DecodePly(std::span<const std::uint8_t> bytes);

/// Binary STL (no colour); the 80-byte header holds `header` cut to 79 characters and never starts with "solid".
std::vector<std::uint8_t> EncodeStl(const Surface& surface, std::string_view header);

}  // namespace striae
