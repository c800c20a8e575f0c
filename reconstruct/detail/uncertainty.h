// How sure each pixel's stripe order is.
#pragma once

#include "core/calibration.h"
#include "core/image.h"

namespace striae::reconstruct::detail {

/// Standard uncertainty of the order (stripes), in the place of the amplitude; from five sources, in quadrature: the
/// sensor's noise through the window, noise / (2 pi amplitude); what the window does to a curved order (half of its
/// kernel's second moment times the second derivative along the line); stripes that lie so close or so wide that a
/// step may be smoothed over; the neighbourhood of a border, where the window
/// mixes lit with unlit; and a floor for texture. `order` is the absolute order, NaN where there is none; `period_px`
/// the carrier's. The background's place is taken by the modulation.
void OrderUncertainty(const ImageF& order, StripeDirection direction, double period_px, double window_half_width,
                      double noise, ImageF& amplitude, ImageF& background);

}  // namespace striae::reconstruct::detail
