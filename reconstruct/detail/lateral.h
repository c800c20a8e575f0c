// Smoothing along the stripes: the second direction of the Fourier window.
#pragma once

#include "core/calibration.h"
#include "core/image.h"

namespace striae::reconstruct::detail {

/// Averages each pixel's order with pairs of pixels on either side of it along the stripe, weighted by a Gaussian of
/// `sigma_px`. A pair takes part only while its mean differs from the pixel by no more than the noise around explains:
/// a slope of any steepness stays as it is, and a rim, a step or a fold keeps its shape, where a plain two-dimensional
/// window would round it. The noise is found in cells of 16 x 16 pixels from fourth differences along the stripe, which
/// smooth surfaces do not have. NaN pixels stay NaN and take no part.
ImageF SmoothAlongStripes(ImageF order, StripeDirection direction, double sigma_px);

}  // namespace striae::reconstruct::detail
