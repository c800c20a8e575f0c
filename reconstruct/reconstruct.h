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
#include "reconstruct/calibration_uncertainty.h"
#include "reconstruct/order.h"
#include "reconstruct/phase.h"
#include "reconstruct/sensor_surface.h"
#include "reconstruct/target.h"

namespace striae::reconstruct {

struct ReconstructOptions {
  PhaseOptions phase;
  /// Where stripes go on along the line on either side, points are kept up to this standard uncertainty of their depth,
  /// as their misfit gives it, where that allows more than the phase's own most_misfit: at 1 m a stripe is 17 mm of
  /// depth and the walls of a wound are worth having; at 2 m it is 120 mm.
  double most_misfit_mm = 2;
  std::optional<double> distance_mm;    ///< hint; the middle of the calibration's working distance when not given
  std::optional<double> label_side_mm;  ///< a label of this size is looked for; needs `find_target`
  /// FindTarget of reconstruct/target.h. A pointer, so that a program that looks for no label need not load what finds
  /// them.
  std::optional<TargetSighting> (*find_target)(const PhaseResult&, const CameraModel&, double side_mm) = nullptr;
  bool faces = true;
  /// Smoothing of the order along the stripes (standard deviation in periods), where the noise is larger than the
  /// shape.
  double smoothing_along = 0.3;
  /// Points whose depth lies further outside of the working distance than this share of it are no part of the subject.
  double outside_working_share = 0.12;
};

/// What is said of a surface.
struct ReconstructionReport {
  std::vector<RegionOrder> regions;  ///< largest first; those without an order are not in the surface
  double coverage = 0;               ///< share of the lit field that has a point
  double carrier_period_px = 0;
  LocalPeriods local_periods;
  StripeDirection direction = StripeDirection::kHorizontal;
  /// What the calibration may move all points together by; also in the surface's comments. Not part of the points' own
  /// uncertainty. Empty where the calibration carries no covariance.
  std::optional<CalibrationDepthUncertainty> of_calibration;
  std::optional<TargetSighting> target;                 ///< the label, when one was looked for and found
  std::vector<std::string> warnings;                    ///< also in the surface's comments, as "warning: ..."
  std::vector<std::pair<std::string, double>> seconds;  ///< per stage, in their order; filled by `clock`
};

struct Reconstruction : ReconstructionReport {
  Surface surface;
};

struct SensorReconstruction : ReconstructionReport {
  SensorSurface surface;
};

/// The misfit that `most_misfit_mm` means in the middle of the rig's working distance, at least the phase's own.
double MostMisfitInside(const Calibration& calibration, const ReconstructOptions& options);

/// Reads a monotone clock in seconds; stages are timed with it when given (nothing here reads a clock itself).
using Clock = double (*)();

/// kCalibrationMismatch when the photograph's size or stripe direction is not the calibration's; kNoCarrier and
/// kBadImage as MeasurePhase; kMeasurementRefused when no point lies within the working distance.
/// The photograph's memory is used again when it is moved in.
Result<SensorReconstruction> ReconstructOnSensor(Photograph photograph, const Calibration& calibration,
                                                 const ReconstructOptions& options, Clock clock = nullptr);

/// The same with the surface as lists.
Result<Reconstruction> Reconstruct(Photograph photograph, const Calibration& calibration,
                                   const ReconstructOptions& options, Clock clock = nullptr);

}  // namespace striae::reconstruct
