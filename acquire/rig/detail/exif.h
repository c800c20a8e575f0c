// EXIF as a Nikon D90 writes it, put into a JPEG by Exiv2.
#pragma once

#include <cstdint>
#include <vector>

#include "acquire/rig/photograph_file.h"

namespace striae::rig::detail {

Result<std::vector<std::uint8_t>> AddExif(const std::vector<std::uint8_t>& jpeg, const CameraTags& tags, int width,
                                          int height);

}  // namespace striae::rig::detail
