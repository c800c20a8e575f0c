// Where the stripes carry phase.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"

namespace striae::reconstruct::detail {

/// Breaks bridges thinner than about three pixels (3 x 3 opening), then drops connected regions (4-neighbours) of fewer
/// than `least_px` pixels.
void CleanMask(Mask& mask, int least_px);

/// Takes out the pixels where the wrapped phase is not smooth (steps, shadow edges): there unwrapping would guess.
void CutSteps(const ImageF& wrapped, Mask& mask, float largest_second_difference);

}  // namespace striae::reconstruct::detail
