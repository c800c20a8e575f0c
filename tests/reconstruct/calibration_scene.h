// A plate with domes before an invented rig, as phases computed from the geometry: truth for the calibration's solver.
#pragma once

#include <vector>

#include "reconstruct/calibrate/solve.h"

namespace striae::reconstruct::testing {

/// A plate of 300 x 260 mm with five domes; 2 mm triangles.
Surface DomedPlate();

/// Unlike the nominal rig in every number.
Calibration TrueRig();
NominalRig Nominal();
/// Where the plate stands at position 0, and where the slide goes.
CalibrationFit TruePose();

constexpr double kPhaseNoise_stripes = 0.01;

/// What `photographs` at positions `step_mm` apart show: each begins to count at a whole number of its own, and sees
/// the grating's low edge.
std::vector<CalibrationView> PhotographPlate(const ReferenceShape& shape, int photographs, double step_mm,
                                             const Calibration& rig = TrueRig(), unsigned seed = 17);

}  // namespace striae::reconstruct::testing
