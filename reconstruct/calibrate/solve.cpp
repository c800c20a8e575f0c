#include "reconstruct/calibrate/solve.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include <Eigen/Dense>
#include <ceres/ceres.h>

#include "reconstruct/calibrate/detail/order_residual.h"
#include "reconstruct/calibrate/detail/start.h"

namespace striae::reconstruct {
namespace {

using detail::OrderResidual;
using detail::RigParameters;

/// Phase noise assumed of one sample, stripes, until the residuals tell it; the robust loss starts to yield beyond
/// three of them. Caps' rims differ by a hundredth of a stripe, ten times the noise elsewhere, and always to the same
/// side.
constexpr double kSigma_stripes = 0.01, kFinestSigma_stripes = 0.0003;
constexpr double kLoss = 3;
constexpr double kOffsetTolerance = 0.15;  ///< an offset further than this from a whole number has not settled
constexpr double kWorstFixedSdRatio = 1.5;
constexpr std::size_t kFewestSamples = 200;

enum class Free { kPose, kPoseSlideProjector, kAll };

/// A weak belief about one parameter: (value - mean) / sigma.
struct Prior {
  int block = 0;  // 0 camera, 1 projector, 2 pose, 3 slide
  int index = 0;
  double sigma = 1;
};

std::vector<Prior> Priors(const RigParameters& nominal) {
  return {{0, 0, 0.02 * nominal.camera[0]},
          {0, 1, 0.005},
          {0, 2, 50},
          {0, 3, 50},
          {0, 4, 0.1},
          {0, 5, 0.1},
          {1, 0, 10},
          {1, 1, 20},
          {1, 2, 25},
          {1, 3, 0.05},
          {1, 4, 0.03},
          {1, 5, 0.03},
          {1, 6, 0.02 * nominal.projector[6]},
          {1, 7, 15},
          {1, 8, 0.1},
          {3, 0, 0.1},
          {3, 1, 0.1}};
}

struct PriorResidual {
  PriorResidual(int index, double mean, double sigma) : index_(index), mean_(mean), sigma_(sigma) {}
  template <typename T>
  bool operator()(T const* const* blocks, T* residual) const {
    residual[0] = (blocks[0][index_] - mean_) / sigma_;
    return true;
  }
  int index_;
  double mean_, sigma_;
};

class Solver {
 public:
  Solver(const ReferenceShape& shape, const std::vector<CalibrationView>& views, const RigParameters& nominal)
      : shape_(shape), views_(views), nominal_(nominal), parameters_(nominal), offsets_(views.size(), 0.0) {}

  RigParameters& parameters() { return parameters_; }
  std::vector<double>& offsets() { return offsets_; }

  /// Takes the samples that the present estimate sees on the usable part of the reference.
  void SelectSamples(std::size_t most_per_view) {
    selected_.assign(views_.size(), {});
    for (std::size_t v = 0; v < views_.size(); ++v) {
      const auto& samples = views_[v].samples;
      const std::size_t every = std::max<std::size_t>(1, samples.size() / most_per_view);
      for (std::size_t i = 0; i < samples.size(); i += every) {
        if (Usable(samples[i], views_[v].position_mm)) selected_[v].push_back(&samples[i]);
      }
    }
  }

  [[nodiscard]] std::size_t SelectedIn(std::size_t view) const { return selected_[view].size(); }

  /// First guess of every photograph's offset: the median difference.
  void GuessOffsets() {
    for (std::size_t v = 0; v < views_.size(); ++v) {
      std::vector<double> differences;
      for (const OrderSample* sample : selected_[v]) differences.push_back(-Difference(*sample, v, 0));
      const auto middle = differences.begin() + static_cast<long>(differences.size() / 2);
      std::nth_element(differences.begin(), middle, differences.end());
      offsets_[v] = *middle;
    }
  }

  bool Solve(Free free, bool offsets_free, int iterations) {
    ceres::Problem problem;
    Build(problem, free, offsets_free);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.max_num_iterations = iterations;
    options.num_threads = 1;  // sums in one order: the same bytes on every machine
    options.logging_type = ceres::SILENT;
    options.function_tolerance = 1e-9;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return summary.IsSolutionUsable();
  }

  /// From here on samples weigh by the noise that most of them show (1.4826 times the median residual).
  void LearnSigma() {
    std::vector<double> residuals;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      for (const OrderSample* sample : selected_[v]) residuals.push_back(std::abs(Difference(*sample, v, offsets_[v])));
    }
    if (residuals.empty()) return;
    const auto middle = residuals.begin() + static_cast<long>(residuals.size() / 2);
    std::nth_element(residuals.begin(), middle, residuals.end());
    sigma_stripes_ = std::clamp(1.4826 * *middle, kFinestSigma_stripes, kSigma_stripes);
  }

  /// Standard uncertainties of camera and projector from the normal matrix at the solution (robust weights and priors
  /// included, pose and slide free); zeros where it cannot be inverted.
  std::vector<CalibrationFit::Parameter> Uncertainties() {
    static const char* const kNames[] = {"fy",
                                         "fx/fy",
                                         "cx",
                                         "cy",
                                         "k1",
                                         "k2",
                                         "center_x",
                                         "center_y",
                                         "center_z",
                                         "rotation_x",
                                         "rotation_y",
                                         "rotation_z",
                                         "focal_stripes",
                                         "center_order",
                                         "k1_projector"};
    constexpr int kCamera = 6, kRig = 15, kAllParameters = 23;
    ceres::Problem problem;
    Build(problem, Free::kAll, false);
    ceres::Problem::EvaluateOptions options;
    options.parameter_blocks = {parameters_.camera, parameters_.projector, parameters_.pose, parameters_.slide};
    ceres::CRSMatrix jacobian;
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(kAllParameters, kAllParameters);
    if (problem.Evaluate(options, nullptr, nullptr, nullptr, &jacobian)) {
      for (std::size_t row = 0; row + 1 < jacobian.rows.size(); ++row) {
        for (int i = jacobian.rows[row]; i < jacobian.rows[row + 1]; ++i) {
          for (int k = jacobian.rows[row]; k < jacobian.rows[row + 1]; ++k) {
            normal(jacobian.cols[i], jacobian.cols[k]) += jacobian.values[i] * jacobian.values[k];
          }
        }
      }
    }
    // Parameters differ by ten orders of magnitude: scaled to a unit diagonal before inverting.
    const Eigen::VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::FullPivLU<Eigen::MatrixXd> factored(scale.asDiagonal() * normal * scale.asDiagonal());
    const Eigen::MatrixXd covariance =
        factored.isInvertible() ? Eigen::MatrixXd(scale.asDiagonal() * factored.inverse() * scale.asDiagonal())
                                : Eigen::MatrixXd::Zero(kAllParameters, kAllParameters);
    std::vector<CalibrationFit::Parameter> list;
    for (int i = 0; i < kRig; ++i) {
      const double value = i < kCamera ? parameters_.camera[i] : parameters_.projector[i - kCamera];
      list.push_back({kNames[i], value, std::sqrt(std::max(0.0, covariance(i, i)))});
    }
    return list;
  }

  /// sd of measured minus predicted order in one view, stripes.
  double ViewSpread(std::size_t view) const {
    double sum = 0;
    for (const OrderSample* sample : selected_[view]) sum += std::pow(Difference(*sample, view, offsets_[view]), 2);
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, selected_[view].size())));
  }
  double Spread() const {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      sum += std::pow(ViewSpread(v), 2) * static_cast<double>(selected_[v].size());
      count += selected_[v].size();
    }
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, count)));
  }

 private:
  [[nodiscard]] Eigen::Vector3d PointOf(const OrderSample& sample, double position_mm) const {
    double point[3];
    OrderResidual(shape_, sample.pixel, 0, position_mm, 1)
        .PointOnReference(parameters_.camera, parameters_.pose, parameters_.slide, point);
    return {point[0], point[1], point[2]};
  }
  [[nodiscard]] double Difference(const OrderSample& sample, std::size_t view, double offset) const {
    return sample.order + offset -
           detail::OrderOf(parameters_.projector, PointOf(sample, views_[view].position_mm).data());
  }
  [[nodiscard]] bool Usable(const OrderSample& sample, double position_mm) const {
    const Eigen::Vector3d point = PointOf(sample, position_mm);
    const double norm = std::sqrt(1 + std::pow(parameters_.slide[0], 2) + std::pow(parameters_.slide[1], 2));
    const Eigen::Vector3d direction(parameters_.slide[0] / norm, parameters_.slide[1] / norm, 1 / norm);
    const Eigen::Vector3d moved =
        point - Eigen::Map<const Eigen::Vector3d>(parameters_.pose + 3) - position_mm * direction;
    const double inverse[3] = {-parameters_.pose[0], -parameters_.pose[1], -parameters_.pose[2]};
    double in_object[3];
    ceres::AngleAxisRotatePoint(inverse, moved.data(), in_object);
    const auto height = shape_.At(in_object[0], in_object[1]);
    return height && height->usable;
  }

  void Build(ceres::Problem& problem, Free free, bool offsets_free) {
    for (std::size_t v = 0; v < views_.size(); ++v) {
      for (const OrderSample* sample : selected_[v]) {
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<OrderResidual, 1, 6, 9, 6, 2, 1>(new OrderResidual(
                                     shape_, sample->pixel, sample->order, views_[v].position_mm, sigma_stripes_)),
                                 new ceres::CauchyLoss(kLoss), parameters_.camera, parameters_.projector,
                                 parameters_.pose, parameters_.slide, &offsets_[v]);
      }
      if (!offsets_free) problem.SetParameterBlockConstant(&offsets_[v]);
    }
    AddPriors(problem);
    if (free != Free::kAll) problem.SetParameterBlockConstant(parameters_.camera);
    if (free == Free::kPose) {
      problem.SetParameterBlockConstant(parameters_.slide);
      problem.SetParameterBlockConstant(parameters_.projector);
    } else if (offsets_free) {
      // The central order and all offsets together are a pure gauge.
      problem.SetManifold(parameters_.projector, new ceres::SubsetManifold(9, {7}));
    }
  }

  void AddPriors(ceres::Problem& problem) {
    double* const blocks[4] = {parameters_.camera, parameters_.projector, parameters_.pose, parameters_.slide};
    const double* const means[4] = {nominal_.camera, nominal_.projector, nominal_.pose, nominal_.slide};
    const int sizes[4] = {6, 9, 6, 2};
    for (const Prior& prior : Priors(nominal_)) {
      auto* cost = new ceres::DynamicAutoDiffCostFunction<PriorResidual>(
          new PriorResidual(prior.index, means[prior.block][prior.index], prior.sigma));
      cost->AddParameterBlock(sizes[prior.block]);
      cost->SetNumResiduals(1);
      problem.AddResidualBlock(cost, nullptr, blocks[prior.block]);
    }
  }

  const ReferenceShape& shape_;
  const std::vector<CalibrationView>& views_;
  RigParameters nominal_, parameters_;
  std::vector<double> offsets_;
  std::vector<std::vector<const OrderSample*>> selected_;
  double sigma_stripes_ = kSigma_stripes;
};

tl::unexpected<Error> Refuse(const std::string& why) {
  return Fail(ErrorCode::kBadCalibration, "these photographs cannot calibrate the rig: " + why);
}

/// Rounds the offsets to whole numbers about their common fraction, which moves into the central order. Returns each
/// offset's distance from a whole number.
std::vector<double> SettleOffsets(Solver& solver) {
  std::vector<double>& offsets = solver.offsets();
  double cosine = 0, sine = 0;
  for (const double offset : offsets) {
    cosine += std::cos(2 * M_PI * offset);
    sine += std::sin(2 * M_PI * offset);
  }
  const double fraction = std::atan2(sine, cosine) / (2 * M_PI);
  std::vector<double> distances;
  for (double& offset : offsets) {
    const double whole = std::round(offset - fraction);
    distances.push_back(offset - fraction - whole);
    offset = whole;
  }
  solver.parameters().projector[7] -= fraction;
  return distances;
}

/// The whole number that brings the orders at the visible edges of the stripe field to -0.5 and N - 0.5; nullopt when
/// no photograph shows an edge or they disagree.
std::optional<int> GaugeFromEdges(const std::vector<CalibrationView>& views, const std::vector<double>& offsets,
                                  std::optional<int> stripes) {
  if (!stripes) return std::nullopt;
  std::vector<double> shifts;
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (views[v].low_edge_order) shifts.push_back(-0.5 - (*views[v].low_edge_order + offsets[v]));
    if (views[v].high_edge_order) shifts.push_back(*stripes - 0.5 - (*views[v].high_edge_order + offsets[v]));
  }
  if (shifts.empty()) return std::nullopt;
  std::nth_element(shifts.begin(), shifts.begin() + static_cast<long>(shifts.size() / 2), shifts.end());
  const double median = shifts[shifts.size() / 2];
  const auto agrees = [&](double shift) { return std::abs(shift - median) < 0.3; };
  const auto agreeing = std::count_if(shifts.begin(), shifts.end(), agrees);
  if (3 * agreeing < 2 * static_cast<long>(shifts.size()) || std::abs(median - std::round(median)) > 0.3)
    return std::nullopt;
  return static_cast<int>(std::lround(median));
}

Calibration PackCalibration(const RigParameters& p, const NominalRig& nominal) {
  Calibration c;
  c.image_width_px = nominal.image_width_px;
  c.image_height_px = nominal.image_height_px;
  c.camera = {p.camera[0] * p.camera[1], p.camera[0], p.camera[2], p.camera[3], p.camera[4], p.camera[5], 0, 0};
  c.projector.center_mm = Eigen::Map<const Eigen::Vector3d>(p.projector);
  c.projector.rotation_rodrigues = Eigen::Map<const Eigen::Vector3d>(p.projector + 3);
  c.projector.focal_stripes = p.projector[6];
  c.projector.center_order = p.projector[7];
  c.projector.k1 = p.projector[8];
  c.direction = nominal.direction;
  return c;
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

/// From shape alone (real offsets) through rounding to the last solution; the residuals' sd before and after rounding.
struct Solved {
  std::vector<double> distances;
  double sd_free = 0, sd_fixed = 0;
};

Result<Solved> RunStages(Solver& solver) {
  constexpr std::size_t kFew = 700, kMany = 2500, kMost = 6000;
  const auto failed = [] {
    return Refuse("the fit did not converge; check the mesh's unit and axes and the steps' signs");
  };
  solver.SelectSamples(kFew);
  solver.GuessOffsets();
  if (!solver.Solve(Free::kPose, true, 30)) return failed();
  solver.SelectSamples(kFew);
  if (!solver.Solve(Free::kPoseSlideProjector, true, 40)) return failed();
  solver.SelectSamples(kFew);
  if (!solver.Solve(Free::kAll, true, 60)) return failed();
  solver.SelectSamples(kMany);
  if (!solver.Solve(Free::kAll, true, 60)) return failed();
  Solved solved;
  solved.sd_free = solver.Spread();
  solved.distances = SettleOffsets(solver);
  if (!solver.Solve(Free::kAll, false, 60)) return failed();
  solved.sd_fixed = solver.Spread();
  solver.SelectSamples(kMost);
  for (int round = 0; round < 2; ++round) {
    solver.LearnSigma();
    if (!solver.Solve(Free::kAll, false, 60)) return failed();
  }
  return solved;
}

Status Judge(const Solved& solved, const Solver& solver, std::size_t views) {
  for (std::size_t v = 0; v < views; ++v) {
    if (std::abs(solved.distances[v]) > kOffsetTolerance) {
      return Refuse("the stripe count of photograph " + std::to_string(v + 1) + " does not settle (" +
                    std::to_string(solved.distances[v]) + " stripes off); check its position in the steps file");
    }
    if (solver.SelectedIn(v) < kFewestSamples / 2) {
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

}  // namespace

Eigen::Vector3d CalibrationFit::PointInCamera(const Eigen::Vector3d& point_in_object, double position_mm) const {
  return camera_from_object * point_in_object + object_in_camera_mm + position_mm * slide_direction;
}

std::optional<double> CalibrationFit::ReferenceDepth(const ReferenceShape& shape, const Eigen::Vector3d& ray,
                                                     double position_mm, bool usable_only) const {
  const Eigen::Vector3d origin =
      -(camera_from_object.transpose() * (object_in_camera_mm + position_mm * slide_direction));
  const Eigen::Vector3d direction = camera_from_object.transpose() * ray;
  const double depth = detail::MeetRelief(shape, origin, direction);
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

Result<CalibrationFit> SolveCalibration(const ReferenceShape& shape, const std::vector<CalibrationView>& views,
                                        const NominalRig& nominal) {
  if (const Status input = CheckInput(views, nominal); !input) return Fail(input.error());
  RigParameters start = detail::NominalParameters(nominal, shape);
  const auto nearest = std::min_element(views.begin(), views.end(),
                                        [](const auto& a, const auto& b) { return a.position_mm < b.position_mm; });
  start.pose[5] -= nearest->position_mm;
  detail::FindObject(shape, *nearest, start);
  Solver solver(shape, views, start);
  const auto solved = RunStages(solver);
  if (!solved) return Fail(solved.error());
  if (const Status verdict = Judge(*solved, solver, views.size()); !verdict) return Fail(verdict.error());

  CalibrationFit fit;
  const auto gauge = GaugeFromEdges(views, solver.offsets(), nominal.stripes);
  fit.order_is_absolute = gauge.has_value();
  if (gauge) solver.parameters().projector[7] += *gauge;
  if (gauge) {
    for (double& offset : solver.offsets()) offset += *gauge;
  }
  const RigParameters& p = solver.parameters();
  fit.calibration = PackCalibration(p, nominal);
  if (gauge) fit.calibration.stripes = nominal.stripes;
  fit.camera_from_object = RotationFromRodrigues(Eigen::Map<const Eigen::Vector3d>(p.pose));
  fit.object_in_camera_mm = Eigen::Map<const Eigen::Vector3d>(p.pose + 3);
  fit.slide_direction = Eigen::Vector3d(p.slide[0], p.slide[1], 1).normalized();
  for (std::size_t v = 0; v < views.size(); ++v) {
    fit.views.push_back({static_cast<int>(std::lround(solver.offsets()[v])), solved->distances[v], solver.ViewSpread(v),
                         static_cast<int>(solver.SelectedIn(v))});
  }
  fit.sd_stripes = solver.Spread();
  fit.parameters = solver.Uncertainties();
  return fit;
}

}  // namespace striae::reconstruct
