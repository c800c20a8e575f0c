// How a head stands on its torso in a single capture, without a neutral one: less certain, because every person's own
// shape takes the place of the neutral pose.
#pragma once

#include "analysis/head/measure.h"
#include "core/measurement.h"
#include "core/result.h"
#include "core/surface.h"

namespace striae::head {

/// Axes of head and torso from the capture itself. To the right: the normal of the part's symmetry plane, found by
/// registering the part's mirror image to the capture (Combes et al., IEEE CVPR 2008; the linear part of reflection and
/// motion has it as the eigenvector of -1). Up: of the torso the camera's up, of the head the line from the chin to
/// the brow within the symmetry plane, given (`options.regions` brow_px, chin_px) or found (chin by the profile,
/// brow 85 mm above it).
///
/// Measurements and codes as Measure; `axes_source` is "anatomical", `rotation_in_subject` (rows) the head's rotation
/// in the torso's axes; `symmetry_residual_mm`, `overlap` for each part; `landmarks_source` given or found.
/// Uncertainties are those of people's shape, not of the registration: options.symmetry_sd_deg for rotation and tilt,
/// options.profile_sd_deg for flexion; of a turned head the profile's part goes over to tilt, of a tilted one to
/// rotation. kMeasurementRefused where Measure refuses a neutral capture, or a part is not symmetric enough to have a
/// plane.
Result<AnalysisReport> MeasureAbsolute(const Surface& capture, const Options& options = {});

}  // namespace striae::head
