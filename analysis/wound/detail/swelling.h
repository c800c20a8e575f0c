// Swollen skin around a wound: found against healthy skin further out, and where it ends.
#pragma once

#include <vector>

#include "analysis/wound/detail/ring.h"

namespace striae::wound {

struct Swelling {
  bool looked = false;             ///< false: no skin further out that a quadric continues, so nothing is known
  std::vector<double> profile_mm;  ///< height above the outer skin in steps of 1 mm outwards from the line
  double outer_mm = 0;             ///< where that outer skin begins
  double height_mm = 0;            ///< beside the line
  double ends_mm = 0;              ///< 0 without swelling
};

/// Fits a quadric to a ring 14 mm wide whose inner edge moves outwards until the skin inside it meets it without a step
/// of `threshold_mm`; swelling is what then stands higher beside the line than `least_mm`, all around (medians over
/// sectors, so that a scar or a vein is none), and by far higher than the quadric misses the outer skin.
Swelling FindSwelling(const Scene& coarse, double least_mm, double threshold_mm);

}  // namespace striae::wound
