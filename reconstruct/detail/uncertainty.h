// How sure each pixel's stripe order is.
#pragma once

#include <cstdint>
#include <numbers>

#include "core/image.h"

namespace striae::reconstruct::detail {

/// Standard uncertainty of the order (stripes) for a misfit of one: the phase is off by as much as the light, of whose
/// power half turns it and half does not. Rendered bodies give 0.06 to 0.16 for what is above the usual misfit, from
/// 0.005 to 0.5, limbs and plates, walls, folds and silhouettes alike.
constexpr double kStripesOfMisfit = 1 / (2 * std::numbers::pi * std::numbers::sqrt2);

/// Standard uncertainty of the order (stripes), in the place of the amplitude; from three sources, in quadrature: the
/// sensor's noise through the window, noise / (2 pi amplitude); what background and stripes leave of the light
/// beyond what they leave everywhere (PhaseResult::MisfitAt and usual_misfit: what the window cannot follow and what it
/// took up wrongly are about alike; noise, texture and the grating's harmonics turn the phase by much less); and a
/// floor for texture. The background's place is taken by the modulation.
void OrderUncertainty(const Image<std::uint8_t>& misfit, float usual_misfit, double noise, ImageF& amplitude,
                      ImageF& background);

}  // namespace striae::reconstruct::detail
