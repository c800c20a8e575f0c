// Surface <-> binary little-endian PLY. Pure: bytes in, bytes out.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/ply_layout.h"
#include "core/result.h"
#include "core/surface.h"

namespace striae {

/// Vertex element first (float x y z, uchar red green blue, float quality, ushort col row, and float uncertainty in mm
/// where the surface knows it), then faces. The sensor's size and the surface's comments go into comment lines.
std::vector<std::uint8_t> EncodePly(const Surface& surface);

/// The same bytes in order, in pieces of about a megabyte, as SendInOrder: the next one is encoded while `sink` has
/// this one. False as soon as `sink` is.
bool EncodePly(const Surface& surface, const PieceSink& sink);

/// Reads any binary little-endian or ascii PLY with x, y, z; the other properties are optional and of any scalar
/// type. Without "striae sensor" comment the sensor size is the largest col and row + 1. kBadFile when truncated,
/// big-endian, an index is out of range, or a coordinate is not finite.
Result<Surface> DecodePly(std::span<const std::uint8_t> bytes);

}  // namespace striae
