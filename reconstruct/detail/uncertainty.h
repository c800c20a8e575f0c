// How sure each pixel's stripe order is.
#pragma once

#include <cstdint>

#include "core/image.h"

namespace striae::reconstruct::detail {

/// Standard uncertainty of the order (stripes), in the place of the amplitude; from three sources, in quadrature: the
/// sensor's noise through the window, noise / (2 pi amplitude); what background and stripes leave of the light
/// (PhaseResult::MisfitAt: what the window cannot follow and what it took up wrongly are about alike); and a floor for
/// texture. The background's place is taken by the modulation.
void OrderUncertainty(const Image<std::uint8_t>& misfit, double noise, ImageF& amplitude, ImageF& background);

}  // namespace striae::reconstruct::detail
