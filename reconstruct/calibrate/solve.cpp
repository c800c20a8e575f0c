#include "reconstruct/calibrate/solve.h"

#include <algorithm>
#include <cmath>

#include "reconstruct/calibrate/detail/orders.h"
#include "reconstruct/calibrate/detail/pack.h"
#include "reconstruct/calibrate/detail/rig_fit.h"
#include "reconstruct/calibrate/detail/stages.h"
#include "reconstruct/calibrate/detail/start.h"

namespace striae::reconstruct {
namespace {

using detail::ProjectorLaw;
using detail::RigFit;
using detail::RigParameters;
using detail::Solved;

constexpr double kOffsetTolerance = 0.15;  ///< an offset further than this from a whole number has not settled
constexpr double kWorstFixedSdRatio = 1.5;
constexpr double kFarthestFromDesign = 5;  ///< sigmas of the priors
constexpr double kLeastMatch = 0.5;        ///< of the relief's print
constexpr std::size_t kFewestSamples = 200;

tl::unexpected<Error> Refuse(const std::string& why) {
  return Fail(ErrorCode::kBadCalibration, "these photographs cannot calibrate the rig: " + why);
}

Status CheckInput(const std::vector<CalibrationView>& views, const NominalRig& nominal) {
  std::vector<double> positions;
  for (const CalibrationView& view : views) positions.push_back(view.position_mm);
  if (Status slide = CheckSlide(positions, nominal.first_distance_mm); !slide) return slide;
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (views[v].samples.size() < kFewestSamples) {
      return Refuse("photograph " + std::to_string(v + 1) + " shows too few stripes on the object");
    }
  }
  return {};
}

Status Judge(const Solved& solved, const RigFit& fit, std::size_t views) {
  for (std::size_t v = 0; v < views; ++v) {
    if (std::abs(solved.distances[v]) > kOffsetTolerance) {
      return Refuse("the stripe count of photograph " + std::to_string(v + 1) + " does not settle (" +
                    std::to_string(solved.distances[v]) + " stripes off); check its position in the steps file");
    }
    if (fit.SelectedIn(v) < kFewestSamples / 2) {
      return Refuse("the object fills too little of photograph " + std::to_string(v + 1));
    }
  }
  if (solved.sd_fixed > kWorstFixedSdRatio * solved.sd_free + 0.002) {
    return Refuse("fixing whole stripes makes the fit worse (" + std::to_string(solved.sd_free) + " to " +
                  std::to_string(solved.sd_fixed) + " stripes)");
  }
  if (solved.sd_fixed > 0.1) {
    return Refuse("the surface differs from the mesh by " + std::to_string(solved.sd_fixed) +
                  " stripes (sd); is it the right mesh, in mm, x right and y down?");
  }
  return {};
}

/// Least squares or Powell for the pinhole model; for the angular one, from the whole stripes that were found so.
Result<Solved> Run(RigFit& fit, const SolveOptions& options, std::size_t views) {
  const bool powell = options.optimizer == Optimizer::kPowell;
  auto solved = powell ? SolveByPowell(fit, options) : SolveByLeastSquares(fit, options);
  if (!solved) return solved;
  if (const Status verdict = Judge(*solved, fit, views); !verdict) return Fail(verdict.error());
  if (const auto far = detail::FarFromDesign(fit.parameters(), fit.nominal(), fit.law(), kFarthestFromDesign);
      !far.empty()) {
    return Refuse("the solution is no such rig (" + far + "); check the mesh's unit, the steps and the options");
  }
  if (options.model == ProjectorModel::Kind::kPinhole) return solved;
  const ProjectorLaw angular{ProjectorModel::Kind::kAngular, fit.law().axis};
  RigParameters design = detail::AngularFrom(fit.nominal(), angular.axis);
  design.projector[7] += fit.parameters().projector[7] - fit.nominal().projector[7];  // the gauge that has been found
  fit.ChangeLaw(angular, design, detail::AngularFrom(fit.parameters(), angular.axis));
  if (!(powell ? RefineByPowell(fit, options) : RefineByLeastSquares(fit, options))) {
    return Refuse("the angular model did not converge");
  }
  if (const auto far = detail::FarFromDesign(fit.parameters(), fit.nominal(), angular, kFarthestFromDesign);
      !far.empty()) {
    return Refuse("the angular model's solution is no such rig (" + far + ")");
  }
  return solved;
}

}  // namespace

Eigen::Vector3d CalibrationFit::PointInCamera(const Eigen::Vector3d& point_in_object, double position_mm) const {
  return camera_from_object * point_in_object + object_in_camera_mm + position_mm * slide_direction;
}

std::optional<double> CalibrationFit::ReferenceDepth(const ReferenceShape& shape, const Eigen::Vector3d& ray,
                                                     double position_mm, bool usable_only,
                                                     std::optional<double> near_mm) const {
  const Eigen::Vector3d origin =
      -(camera_from_object.transpose() * (object_in_camera_mm + position_mm * slide_direction));
  const Eigen::Vector3d direction = camera_from_object.transpose() * ray;
  const double depth = detail::MeetRelief(shape, origin, direction, near_mm);
  const Eigen::Vector3d p = origin + depth * direction;
  const auto height = shape.At(p.x(), p.y());
  if (!height || (usable_only && !height->usable)) return std::nullopt;
  return depth;
}

Status CheckSlide(const std::vector<double>& positions_mm, double first_distance_mm) {
  constexpr double kLeastTravelShare = 0.05;
  if (positions_mm.size() < 3) {
    return Refuse("fewer than three; photograph the object at about nine positions of the slide");
  }
  const auto [nearest, farthest] = std::minmax_element(positions_mm.begin(), positions_mm.end());
  if (*farthest - *nearest < kLeastTravelShare * first_distance_mm) {
    return Refuse("the slide moved less than 5 % of the distance; use the whole measuring range");
  }
  return {};
}

double MatchOfObject(const ReferenceShape& shape, const CalibrationView& view, const NominalRig& nominal) {
  RigParameters start = detail::NominalParameters(nominal, shape);
  start.pose[5] -= view.position_mm;
  constexpr std::size_t kSamples = 400;
  return detail::FindObject(shape, view, start, kSamples);
}

Status CheckObject(const ReferenceShape& shape, const CalibrationView& view, const NominalRig& nominal) {
  if (view.samples.size() < kFewestSamples) return Refuse("too few stripes on the object");
  const double match = MatchOfObject(shape, view, nominal);
  if (match >= kLeastMatch) return {};
  return Refuse("the relief on the photograph is not the mesh's (they match to " + std::to_string(match).substr(0, 4) +
                "); is it the right mesh and object, in mm, x right, y down, relief towards the camera along -z?");
}

Result<CalibrationFit> SolveCalibration(const ReferenceShape& shape, const std::vector<CalibrationView>& views,
                                        const NominalRig& nominal, const SolveOptions& options) {
  if (const Status input = CheckInput(views, nominal); !input) return Fail(input.error());
  RigParameters start = detail::NominalParameters(nominal, shape);
  const auto nearest = std::min_element(views.begin(), views.end(),
                                        [](const auto& a, const auto& b) { return a.position_mm < b.position_mm; });
  start.pose[5] -= nearest->position_mm;
  detail::FindObject(shape, *nearest, start);
  const int axis = nominal.direction == StripeDirection::kHorizontal ? 1 : 0;
  RigFit solver(shape, views, start, {ProjectorModel::Kind::kPinhole, axis});
  const auto solved = Run(solver, options, views.size());
  if (!solved) return Fail(solved.error());

  CalibrationFit fit;
  std::vector<detail::SeenEdges> edges;
  for (const CalibrationView& view : views) edges.push_back({view.low_edge_order, view.high_edge_order});
  const auto gauge = GaugeFromEdges(edges, solver.offsets(), nominal.stripes);
  fit.order_is_absolute = gauge.has_value();
  const int whole = gauge.value_or(0);
  solver.parameters().projector[7] += whole;
  for (double& offset : solver.offsets()) offset += whole;
  const RigParameters& p = solver.parameters();
  fit.calibration = PackCalibration(p, solver.law(), nominal);
  if (gauge) fit.calibration.stripes = nominal.stripes;
  fit.camera_from_object = RotationFromRodrigues(Eigen::Map<const Eigen::Vector3d>(p.pose));
  fit.object_in_camera_mm = Eigen::Map<const Eigen::Vector3d>(p.pose + 3);
  fit.slide_direction = Eigen::Vector3d(p.slide[0], p.slide[1], 1).normalized();
  for (std::size_t v = 0; v < views.size(); ++v) {
    fit.views.push_back({static_cast<int>(std::lround(solver.offsets()[v])), solved->distances[v], solver.ViewSpread(v),
                         static_cast<int>(solver.SelectedIn(v))});
  }
  fit.sd_stripes = solver.Spread();
  const Eigen::MatrixXd covariance = solver.Covariance();
  ReportParameters(covariance, p, solver.law(), fit.parameters, fit.correlations);
  if (covariance.trace() > 0) fit.calibration.uncertainty = PackUncertainty(covariance, p, solver.law());
  return fit;
}

}  // namespace striae::reconstruct
