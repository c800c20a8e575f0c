// The deepest point, freed of what smoothing and the Fourier window take from it.
#pragma once

#include "analysis/wound/detail/quantities.h"

namespace striae::wound {

struct Deepest {
  Eigen::Vector2d at_px = Eigen::Vector2d::Zero();  ///< where, sensor pixels
  double depth_mm = 0;                              ///< along the skin's normal
  double noise_mm = 0;       ///< standard uncertainty from the fit's residuals, which hang together over a stripe
  double correction_mm = 0;  ///< what of it undoes the window
  double surface_mm = 0;     ///< by how much the surface is less certain there than on the skin around
};

/// A quadratic through the unsmoothed heights within `radius_mm` of where the smoothed bed is deepest, robust against
/// single points; its top inside that circle. A smooth kernel of standard deviation s takes s^2 / 2 of a surface's
/// second derivative away: that is given back for the window's `resolution_mm` across the stripes (along rows or
/// columns of the sensor, whichever bends more: their direction is not in a surface's file). The answer is never
/// shallower than the smoothed depth, nor deeper than it by more than `most` of it: nothing then is known of so sharp a
/// pit.
Deepest FindDeepest(const Scene& scene, const Bed& bed, const Skin& skin, const Depths& smoothed, double radius_mm,
                    double resolution_mm, double skin_uncertainty_mm);

}  // namespace striae::wound
