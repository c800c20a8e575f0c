// Surface <-> Wavefront OBJ with a texture (MTL). Pure: text in, text out.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/image.h"
#include "core/result.h"
#include "core/surface.h"

namespace striae {

/// v (mm, camera frame), vt from the sensor pixels (u = (col + 1/2) / width, v = 1 - (row + 1/2) / height), f a/a b/b
/// c/c. `mtl_name` is the material library's file name, beside the OBJ; no texture when it is empty or the surface has
/// no pixels.
std::string EncodeObj(const Surface& surface, std::string_view mtl_name);

/// One material, unlit in effect: the photograph's light is in the texture already.
std::string EncodeMtl(std::string_view texture_name);

/// The picture that EncodeObj's texture coordinates point into: the surface's colours at their pixels, spread by
/// `margin_px` beyond its rims so that filtering takes nothing foreign in; mean colour elsewhere. The sensor's size.
ImageRgb TextureOf(const Surface& surface, int margin_px = 4);

/// Reads v and f (polygons become fans, negative indices count from the end); texture coordinates and all else are
/// passed over. kBadFile for an index that is not there, a coordinate that is not finite, or no vertex at all.
Result<Surface> DecodeObj(std::string_view text);

}  // namespace striae
