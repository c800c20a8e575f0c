// Pictures as small as the page shows them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/result.h"

namespace striae::report::detail {

struct Thumbnail {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> jpeg;
};

/// Decoded, scaled into 760 x 760 px and written as JPEG. kBadImage when it cannot be read.
Result<Thumbnail> MakeThumbnail(const std::vector<std::uint8_t>& picture);

}  // namespace striae::report::detail
