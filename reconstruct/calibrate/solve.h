// The paper's calibration: a reference object of known shape on a sliding table, photographed at known steps.
// Unknown are the camera, the projector, the object's pose, the slide's direction and every photograph's whole stripe
// number; nothing but the steps, the mesh and the rig's nominal geometry is given (OPTICS "Calibration").
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/calibration.h"
#include "core/result.h"
#include "reconstruct/calibrate/reference_shape.h"

namespace striae::reconstruct {

/// One measured phase of a calibration photograph.
struct OrderSample {
  Eigen::Vector2d pixel;  ///< sensor pixels
  double order = 0;       ///< unwrapped phase / 2 pi; one sheet for each photograph, its whole number unknown
};

struct CalibrationView {
  double position_mm = 0;  ///< of the sliding table; grows away from the camera
  std::vector<OrderSample> samples;
  /// Relative order at which the stripe field's own edges were seen (low: near n = -0.5, high: near N - 0.5).
  std::optional<double> low_edge_order, high_edge_order;
};

/// What is known beforehand: the rig as designed.
struct NominalRig {
  int image_width_px = 0, image_height_px = 0;
  StripeDirection direction = StripeDirection::kHorizontal;
  double pixel_pitch_mm = 0.0055;
  double camera_focal_mm = 50, projector_focal_mm = 25;
  double grating_period_mm = 0.048;
  std::optional<int> stripes;
  double first_distance_mm = 1000;  ///< camera to object in the photograph at the smallest position, roughly
  Eigen::Vector3d projector_center_mm = {0, -115, 45};
};

enum class Optimizer {
  kLevenbergMarquardt,  ///< robust least squares in stripes (Ceres)
  kPowell,              ///< the paper's: Powell's method (Brent's PRAXIS) on the sd of the differences in mm
};

struct SolveOptions {
  /// The angular model is fitted where the pinhole model has found the whole stripes: it leaves too much for them to
  /// settle.
  ProjectorModel::Kind model = ProjectorModel::Kind::kPinhole;
  Optimizer optimizer = Optimizer::kLevenbergMarquardt;
  /// Told now and then how far the solution is (0..1) and what is done.
  std::function<void(double, const std::string&)> progress;
};

struct ViewFit {
  int whole_stripes = 0;              ///< added to the photograph's own order
  double offset_before_rounding = 0;  ///< whole stripes added, less its rounding and the common part: near zero
  double sd_stripes = 0;
  int samples = 0;
};

struct CalibrationFit {
  Calibration calibration;
  Eigen::Matrix3d camera_from_object = Eigen::Matrix3d::Identity();
  Eigen::Vector3d object_in_camera_mm = Eigen::Vector3d::Zero();  ///< at position 0
  Eigen::Vector3d slide_direction = Eigen::Vector3d::UnitZ();
  std::vector<ViewFit> views;
  double sd_stripes = 0;
  bool order_is_absolute = false;  ///< a grating edge fixed the central order
  struct Parameter {
    std::string name;
    double value = 0, uncertainty = 0;
  };
  std::vector<Parameter> parameters;
  /// Pairs of parameters that the photographs hardly tell apart (|correlation| > 0.99): only together are they known.
  struct Correlation {
    std::string first, second;
    double value = 0;
  };
  std::vector<Correlation> correlations;

  /// A point of the reference object, photographed at `position_mm`, in the camera frame.
  [[nodiscard]] Eigen::Vector3d PointInCamera(const Eigen::Vector3d& point_in_object, double position_mm) const;
  /// Depth (z, mm) at which a ray (z = 1) meets the reference at that position; nullopt beside it or near its steps
  /// when `usable_only`. `near_mm` is a depth near it, when one is known.
  [[nodiscard]] std::optional<double> ReferenceDepth(const ReferenceShape& shape, const Eigen::Vector3d& ray,
                                                     double position_mm, bool usable_only,
                                                     std::optional<double> near_mm = {}) const;
};

/// kBadCalibration when fewer than three positions, or a slide that moved less than 5 % of the distance, cannot
/// determine a rig. SolveCalibration asks it too; ask it before measuring photographs.
Status CheckSlide(const std::vector<double>& positions_mm, double first_distance_mm);

/// How well the relief's print on one photograph's stripes matches the reference, 0..1, wherever it is in the field:
/// the correlation of orders less their best quadratic in the pixel. Quick; the nominal rig is enough.
double MatchOfObject(const ReferenceShape& shape, const CalibrationView& view, const NominalRig& nominal);

/// kBadCalibration when a photograph cannot show the reference: too few stripes, or another relief.
Status CheckObject(const ReferenceShape& shape, const CalibrationView& view, const NominalRig& nominal);

/// kBadCalibration with the reason when the photographs cannot determine the parameters: fewer than three positions,
/// offsets that do not settle near whole numbers, a fit that gets worse when they are fixed, parameters far from any
/// rig.
Result<CalibrationFit> SolveCalibration(const ReferenceShape& shape, const std::vector<CalibrationView>& views,
                                        const NominalRig& nominal, const SolveOptions& options = {});

}  // namespace striae::reconstruct
