// What is wrong with a photograph although stripes are found in it.
#pragma once

#include <string>
#include <vector>

#include "core/image.h"
#include "reconstruct/phase.h"

namespace striae::reconstruct {

struct PhotographQuality {
  /// Modulation of the well lit half of the measured pixels (median of their upper half), 0..1. A sharp photograph of a
  /// Ronchi grating has 0.6 to 1; defocus, motion across the stripes and room light lower it.
  double modulation = 0;
  /// Share of the tiles of measured pixels in which a second pattern of its own period rivals the stripes.
  double second_pattern_share = 0;
  /// Period across the stripes of that pattern, px (median of those tiles); 0 when there is none.
  double second_period_px = 0;
  std::vector<std::string> warnings;  ///< what is wrong and what to do; empty when nothing is
};

/// Looks at tiles of 12 stripe periods, inside the mask, along lines across the stripes: the periodogram (Hann) of the
/// luminance (of the colour) over its local mean. A second peak that is no harmonic and no side of the stripes' own
/// peak, with at least 4 % of its power, is a second pattern: striped or checked cloth, a screen, a second projector.
/// Nothing is found of patterns within 15 % of the stripes' own frequency (they beat, and lower the modulation in bands
/// instead).
PhotographQuality JudgePhotograph(const Photograph& photograph, const PhaseResult& phase);

}  // namespace striae::reconstruct
