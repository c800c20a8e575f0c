// Which pixels of sixteen lines carry phase: how far the light follows its stripes, and the mask's rules.
#pragma once

#include <cstdint>

#include "reconstruct/detail/line_block.h"

namespace striae::reconstruct::detail {

/// Largest value from `reach` positions before to `reach` after (van Herk, Pattern Recognition Letters 13 (1992) 517).
/// `scratch` becomes as long as it needs to be.
void LaneMaximum(const float* in, int length, int reach, float* out, Lanes<float>& scratch);

/// How far light without its background is from following the stripes: sqrt(1 - r^2), where r is the correlation (about
/// zero) of the two over thirteen groups of positions around each, by the sums of every two neighbouring groups. 0
/// where the light is the stripes times any factor, 1 where it has nothing of them. Kept as 255 times its root, the
/// same for all positions of a group.
void LaneMisfit(const float* light, const float* background, const float* stripes, int length, int group,
                Lanes<float>& scratch, std::uint8_t* misfit);

/// Largest value of every `group` neighbouring positions; out has ceil(length / group) * kLanes values.
void GroupMaximum(const float* in, int length, int group, float* out);

/// What the mask asks of a pixel, besides its neighbourhood.
struct MaskLimits {
  float least_amplitude = 0;   ///< against the noise
  float least_modulation = 0;  ///< amplitude over background
  float most_modulation = 2;   ///< the same
  float least_share = 0;       ///< of the plateau around
  int least_run_px = 1;        ///< along the line
  int rim_px = 0;              ///< taken off a run's ends
};

/// mask = 1 where the limits hold. `maximum` is LaneMaximum's over groups of `group` positions.
void JudgeLanes(const float* amplitude, const float* background, const float* maximum, int length, int group,
                const MaskLimits& limits, std::uint8_t* mask);

/// Takes out runs of valid pixels shorter than `least` along each lane.
void DropShortRuns(std::uint8_t* mask, int length, int least, Lanes<std::uint16_t>& scratch);

/// Takes `rim` pixels off both ends of every run along each lane, but not at the lane's own ends.
void TrimRuns(std::uint8_t* mask, int length, int rim, Lanes<std::uint16_t>& scratch);

}  // namespace striae::reconstruct::detail
