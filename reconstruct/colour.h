// The subject's own colour from a photograph under stripes.
#pragma once

#include "core/calibration.h"
#include "core/image.h"

namespace striae::reconstruct {

/// Colour without stripes: along every line across the stripes, the colours around the bright centres (whole orders)
/// are interpolated across the dark between them. Where a line has no bright centre nearby, the photograph's own colour
/// stays.
ImageRgb ColourWithoutStripes(const ImageRgb& photograph, const ImageF& order, StripeDirection direction);

}  // namespace striae::reconstruct
