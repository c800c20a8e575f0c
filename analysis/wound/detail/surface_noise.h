// What a surface is uncertain by inside the wound, from its own points.
#pragma once

#include <vector>

#include "analysis/wound/detail/bed.h"

namespace striae::wound {

/// Robust sd of smoothed heights over the ring, mm.
double SmoothedRingSd(const Scene& scene, const std::vector<double>& smoothed, const Ring& ring);

/// Median of the standard uncertainties that the surface names over the ring, mm; 0 where it names none.
double SkinUncertainty(const Scene& scene, const Ring& ring);

/// By how much a point of uncertainty `mm` is less certain than the skin, whose own scatter is counted with the ring.
double BeyondSkin(double mm, double skin_mm);

/// Standard uncertainty of the bed's volume, mm3: the points' uncertainties beyond the skin's. They are largest beside
/// walls and shadows, where neighbours err alike over 0.6 of the stripes' distance either way.
double VolumeSdOfBed(const Scene& scene, const Bed& bed, double skin_mm, double stripe_mm);

}  // namespace striae::wound
