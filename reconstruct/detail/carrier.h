// Which periodic pattern runs across the lines.
#pragma once

#include <optional>
#include <vector>

#include "core/image.h"
#include "reconstruct/detail/line_block.h"

namespace striae::reconstruct::detail {

/// Evenly spread lines of a photograph in linear light: enough for whatever concerns the photograph as a whole.
struct SampledLines {
  int length = 0;
  std::vector<Lanes<float>> blocks;  ///< kLanes lines each
};
/// At most 192 lines. `linear` light is taken as it is, sRGB is decoded.
SampledLines SampleLines(const ImageF& encoded, const LineLayout& layout, bool linear);

struct Carrier {
  double period_px = 0;
  double prominence = 0;  ///< peak over the higher of the two valleys beside it; natural scenes stay below about 2
};

/// The strongest periodic pattern along the lines: the peak of the mean power spectrum weighted with the frequency
/// (natural scenes fall with it). nullopt when the lines are shorter than eight periods of anything.
std::optional<Carrier> FindCarrier(const SampledLines& lines);

}  // namespace striae::reconstruct::detail
