// How sure each pixel's stripe order is.
#pragma once

#include "core/calibration.h"
#include "core/image.h"

namespace striae::reconstruct::detail {

/// Standard uncertainty of the order (stripes), in the place of the amplitude; from three sources, in quadrature:
/// the sensor's noise through the window, noise / (2 pi amplitude); what the window does to a curved order (its
/// kernel's second moment m times half of the second derivative along the line, and of the amplitude's slope); and a
/// floor for texture. Where a line ends within a quarter period, the window mixes lit with unlit: the largest of the
/// three. `order` is the absolute order, NaN where there is none; `period_px` the carrier's. The background's place is
/// taken by the modulation.
void OrderUncertainty(const ImageF& order, StripeDirection direction, double period_px, double window_half_width,
                      double noise, ImageF& amplitude, ImageF& background);

}  // namespace striae::reconstruct::detail
