// Where the stripes carry phase.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"

namespace striae::reconstruct::detail {

/// Largest value from `before` pixels before to `after` pixels after, along a line (van Herk, Pattern Recognition
/// Letters 13 (1992) 517: two running maxima over blocks of the window's length).
class LineMaximum {
 public:
  LineMaximum(int before, int after) : before_(before), length_(before + after + 1) {}
  void operator()(const float* in, int width, float* out);

 private:
  int before_, length_;
  std::vector<float> rising_, falling_;
};

/// Breaks bridges thinner than about three pixels (3 x 3 opening), then drops connected regions (4-neighbours) of fewer
/// than `least_px` pixels.
void CleanMask(Mask& mask, int least_px);

/// Takes out the pixels where the wrapped phase is not smooth (steps, shadow edges): there unwrapping would guess.
void CutSteps(const ImageF& wrapped, Mask& mask, float largest_second_difference);

}  // namespace striae::reconstruct::detail
