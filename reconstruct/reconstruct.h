// Photograph + calibration -> coloured surface. The one call of this module that the pipeline makes.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/calibration.h"
#include "core/image.h"
#include "core/result.h"
#include "core/surface.h"
#include "reconstruct/order.h"
#include "reconstruct/phase.h"

namespace striae::reconstruct {

struct ReconstructOptions {
  PhaseOptions phase;
  std::optional<double> distance_mm;  ///< hint; the middle of the calibration's working distance when not given
  bool faces = true;
  /// Smoothing of the order along the stripes (standard deviation in periods), where the noise is larger than the
  /// shape.
  double smoothing_along = 0.25;
  /// Points whose depth lies further outside of the working distance than this share of it are no part of the subject.
  double outside_working_share = 0.12;
};

struct Reconstruction {
  Surface surface;
  std::vector<RegionOrder> regions;  ///< largest first; those without an order are not in the surface
  double coverage = 0;               ///< share of the lit field that has a point
  double carrier_period_px = 0;
  StripeDirection direction = StripeDirection::kHorizontal;
  std::vector<std::string> warnings;
  std::vector<std::pair<std::string, double>> seconds;  ///< per stage, in their order; filled by `clock`
};

/// Reads a monotone clock in seconds; stages are timed with it when given (nothing here reads a clock itself).
using Clock = double (*)();

/// kCalibrationMismatch when the photograph's size or stripe direction is not the calibration's; kNoCarrier and
/// kBadImage as MeasurePhase; kMeasurementRefused when no point lies within the working distance.
Result<Reconstruction> Reconstruct(const Photograph& photograph, const Calibration& calibration,
                                   const ReconstructOptions& options, Clock clock = nullptr);

}  // namespace striae::reconstruct
