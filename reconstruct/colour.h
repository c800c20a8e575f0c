// The subject's own colour from a photograph under stripes.
#pragma once

#include "core/calibration.h"
#include "core/image.h"

namespace striae::reconstruct {

/// Colour without stripes: along every line across the stripes, the mean colours of the bright centres (within a tenth
/// of a stripe of whole orders) are joined by straight lines across the dark between them. Nothing is taken across a
/// gap or a step of a quarter stripe between neighbours, where another surface begins: there the nearest bright centre
/// of the same surface holds. A piece without any bright centre, and all without an order, keep the photograph's own
/// colour. `order` is the absolute stripe order of each pixel, NaN where there is none. In the place of
/// the photograph, if it is moved in.
ImageRgb ColourWithoutStripes(ImageRgb photograph, const ImageF& order, StripeDirection direction);

}  // namespace striae::reconstruct
