// Between a calibration's photographs and its solver: what is measured of each photograph beforehand, and how well the
// surfaces reconstructed with the found rig agree with the reference object afterwards.
#pragma once

#include <vector>

#include "core/image.h"
#include "core/result.h"
#include "core/surface.h"
#include "reconstruct/calibrate/reference_shape.h"
#include "reconstruct/calibrate/solve.h"
#include "reconstruct/phase.h"

namespace striae::reconstruct {

/// Samples of the largest region's sheet on a grid of about 20,000 pixels (each other region has a whole number of its
/// own), away from the mask's rim and from steps, where the Fourier window mixes two surfaces; and the grating's edges.
CalibrationView ViewFromPhase(const PhaseResult& phase, double position_mm);

/// Nearest and farthest depth (z, mm) of the reference where the photographs saw it.
struct DepthSpan {
  double near_mm = 0, far_mm = 0;
};
DepthSpan ObjectSpan(const CalibrationFit& fit, const ReferenceShape& shape, const std::vector<CalibrationView>& views);

/// Reconstructed minus reference depth along the ray, mm.
struct Differences {
  std::vector<float> values_mm;  ///< every point whose ray meets the reference, in the surface's order; never trimmed
  ImageF map_mm;                 ///< means over squares of `cell_px` sensor pixels; NaN where no point is
  int cell_px = 16;
};
/// The surface must lie on the sensor's grid (std::logic_error).
Differences CompareWithReference(const Surface& surface, const CalibrationFit& fit, const ReferenceShape& shape,
                                 double position_mm);

struct Spread {
  std::size_t count = 0;
  double mean = 0, sd = 0;           ///< over all values
  double median = 0, robust_sd = 0;  ///< 1.4826 times the median absolute deviation
};
Spread SpreadOf(std::vector<float> values);

/// kBadCalibration when the surfaces do not agree with the reference as those of a right calibration do: the wrong
/// mesh, or a photograph at another position than written. One entry of `photographs` for each view, in its order.
Status JudgeSpread(const Spread& all, const std::vector<Spread>& photographs, double distance_mm);

}  // namespace striae::reconstruct
