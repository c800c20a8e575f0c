#include "reconstruct/calibrate/detail/rig_fit.h"

#include <algorithm>
#include <cmath>

#include <ceres/ceres.h>

#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {
namespace {

/// Phase noise assumed of one sample, stripes, until the residuals tell it; the robust loss starts to yield beyond
/// three of them. Caps' rims differ by a hundredth of a stripe, ten times the noise elsewhere, and always to the same
/// side.
constexpr double kFinestSigma_stripes = 0.0003, kCoarsestSigma_stripes = 0.01;
/// What a law of the wrong shape leaves is one smooth function of the field. All samples together then count as this
/// many independent ones, or they would outweigh every belief about the rig.
constexpr double kTermsOfMisfit = 30;
constexpr double kLoss = 3;
constexpr int kBlock = 128;

/// All samples of one photograph. Each line is computed alone, so the number of threads changes no byte. The robust
/// loss is inside (residual = sqrt(rho)), because Ceres would apply it to the whole photograph.
class ViewResiduals : public ceres::CostFunction {
 public:
  ViewResiduals(const ReferenceShape& shape, const ProjectorLaw& law, const std::vector<const OrderSample*>& samples,
                double position_mm, double sigma)
      : shape_(shape), law_(law), samples_(samples), position_mm_(position_mm), sigma_(sigma) {
    set_num_residuals(static_cast<int>(samples.size()));
    for (const int size : kBlockSizes) mutable_parameter_block_sizes()->push_back(size);
    mutable_parameter_block_sizes()->push_back(1);
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    ParallelBlocks(
        num_residuals(),
        [&](int, int first, int last) {
          if (jacobians == nullptr) {
            Plain(blocks, first, last, residuals);
          } else {
            WithDerivatives(blocks, first, last, residuals, jacobians);
          }
        },
        kBlock);
    return true;
  }

 private:
  /// Cauchy: rho = c^2 log(1 + r^2 / c^2); returns sign(r) sqrt(rho) and its derivative by r.
  static std::pair<double, double> Robust(double r) {
    const double s = r * r / (kLoss * kLoss);
    if (s < 1e-10) return {r, 1};
    const double root = kLoss * std::sqrt(std::log1p(s));
    return {r < 0 ? -root : root, std::abs(r) / (root * (1 + s))};
  }

  void Plain(double const* const* blocks, int first, int last, double* residuals) const {
    const RayOnReference<double> reference(shape_, blocks[2], blocks[3]);
    for (int i = first; i < last; ++i) {
      const OrderSample& sample = *samples_[static_cast<std::size_t>(i)];
      double point[3];
      reference(blocks[0], sample.pixel, position_mm_, point);
      residuals[i] = Robust((sample.order + blocks[4][0] - OrderOf(law_, blocks[1], point)) / sigma_).first;
    }
  }

  void WithDerivatives(double const* const* blocks, int first, int last, double* residuals, double** jacobians) const {
    using J = ceres::Jet<double, kAllSize>;
    J all[kAllSize];
    for (int b = 0, at = 0; b < 4; ++b) {
      for (int i = 0; i < kBlockSizes[b]; ++i, ++at) all[at] = J(blocks[b][i], at);
    }
    const J *camera = all, *projector = all + 6, *pose = all + 15, *slide = all + 21;
    const RayOnReference<J> reference(shape_, pose, slide);
    for (int i = first; i < last; ++i) {
      const OrderSample& sample = *samples_[static_cast<std::size_t>(i)];
      J point[3];
      reference(camera, sample.pixel, position_mm_, point);
      const J difference = (sample.order + blocks[4][0] - OrderOf(law_, projector, point)) / sigma_;
      const auto [residual, slope] = Robust(difference.a);
      residuals[i] = residual;
      for (int b = 0, at = 0; b < 4; at += kBlockSizes[b++]) {
        if (jacobians[b] == nullptr) continue;
        for (int k = 0; k < kBlockSizes[b]; ++k) jacobians[b][i * kBlockSizes[b] + k] = slope * difference.v[at + k];
      }
      if (jacobians[4] != nullptr) jacobians[4][i] = slope / sigma_;
    }
  }

  const ReferenceShape& shape_;
  ProjectorLaw law_;
  const std::vector<const OrderSample*>& samples_;
  double position_mm_, sigma_;
};

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void RigFit::ChangeLaw(const ProjectorLaw& law, const RigParameters& nominal, const RigParameters& start) {
  camera_covariance_ = Covariance().topLeftCorner(kBlockSizes[0], kBlockSizes[0]);
  law_ = law;
  nominal_ = nominal;
  parameters_ = start;
  misfit_is_systematic_ = true;
  LearnSigma();
}

void RigFit::SelectSamples(std::size_t most_per_view) {
  selected_.assign(views_.size(), {});
  const RayOnReference<double> reference(shape_, parameters_.pose, parameters_.slide);
  for (std::size_t v = 0; v < views_.size(); ++v) {
    const auto& samples = views_[v].samples;
    const std::size_t every = std::max<std::size_t>(1, samples.size() / most_per_view);
    for (std::size_t i = 0; i < samples.size(); i += every) {
      double point[3];
      const auto height = reference(parameters_.camera, samples[i].pixel, views_[v].position_mm, point);
      if (height.usable) selected_[v].push_back(&samples[i]);
    }
  }
}

std::vector<double> RigFit::Differences(std::size_t view) const {
  std::vector<double> differences(selected_[view].size());
  const RayOnReference<double> reference(shape_, parameters_.pose, parameters_.slide);
  for (std::size_t i = 0; i < differences.size(); ++i) {
    const OrderSample& sample = *selected_[view][i];
    double point[3];
    reference(parameters_.camera, sample.pixel, views_[view].position_mm, point);
    differences[i] = sample.order + offsets_[view] - OrderOf(law_, parameters_.projector, point);
  }
  return differences;
}

std::vector<RigFit::DepthDifference> RigFit::DepthDifferences(const RigParameters& at, std::size_t view) const {
  std::vector<DepthDifference> differences(selected_[view].size());
  const RayOnReference<double> reference(shape_, at.pose, at.slide);
  constexpr double kStep = 1e-4;  // of the depth
  // Asked tens of thousands of times for few samples: handing them to other threads would cost more than the work.
  for (std::size_t i = 0; i < differences.size(); ++i) {
    const OrderSample& sample = *selected_[view][i];
    double point[3];
    reference(at.camera, sample.pixel, views_[view].position_mm, point);
    const double behind[3] = {(1 + kStep) * point[0], (1 + kStep) * point[1], (1 + kStep) * point[2]};
    const double here = OrderOf(law_, at.projector, point);
    const double per_mm = (OrderOf(law_, at.projector, behind) - here) / (kStep * point[2]);
    differences[i] = {(sample.order + offsets_[view] - here) / per_mm, 1 / per_mm};
  }
  return differences;
}

void RigFit::GuessOffsets() {
  for (std::size_t v = 0; v < views_.size(); ++v) {
    offsets_[v] = 0;
    if (!selected_[v].empty()) offsets_[v] = -MedianOf(Differences(v));
  }
}

bool RigFit::Solve(Free free, bool offsets_free, int iterations) {
  ceres::Problem problem;
  Build(problem, free, offsets_free);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = iterations;
  options.num_threads = 1;  // sums in one order: the same bytes on every machine
  options.logging_type = ceres::SILENT;
  // A systematic misfit makes Gauss-Newton's steps converge slowly, to where no digit of the result needs them.
  options.function_tolerance = misfit_is_systematic_ ? 1e-6 : 1e-9;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.IsSolutionUsable();
}

void RigFit::LearnSigma() {
  std::vector<double> residuals;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    for (const double difference : Differences(v)) residuals.push_back(std::abs(difference));
  }
  if (residuals.empty()) return;
  const auto count = static_cast<double>(residuals.size());
  const double sigma = 1.4826 * MedianOf(std::move(residuals));
  sigma_stripes_ = misfit_is_systematic_ ? sigma * std::sqrt(std::max(1.0, count / kTermsOfMisfit))
                                         : std::clamp(sigma, kFinestSigma_stripes, kCoarsestSigma_stripes);
}

double RigFit::ViewSpread(std::size_t view) const {
  double sum = 0;
  for (const double difference : Differences(view)) sum += difference * difference;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, selected_[view].size())));
}

double RigFit::Spread() const {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    sum += std::pow(ViewSpread(v), 2) * static_cast<double>(selected_[v].size());
    count += selected_[v].size();
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, count)));
}

void RigFit::Build(ceres::Problem& problem, Free free, bool offsets_free) {
  RigParameters& p = parameters_;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (selected_[v].empty()) continue;
    problem.AddResidualBlock(new ViewResiduals(shape_, law_, selected_[v], views_[v].position_mm, sigma_stripes_),
                             nullptr, p.camera, p.projector, p.pose, p.slide, &offsets_[v]);
    if (!offsets_free) problem.SetParameterBlockConstant(&offsets_[v]);
  }
  AddPriors(Priors(nominal_, law_, true), nominal_, parameters_, problem);
  // A law of the wrong shape is compared with the camera as it was found: left free, it would bend to hide the misfit
  // (k2 = 2.5, focal lengths off by a fifth).
  if (free != Free::kAll || misfit_is_systematic_) problem.SetParameterBlockConstant(p.camera);
  if (free == Free::kPose) {
    problem.SetParameterBlockConstant(p.slide);
    problem.SetParameterBlockConstant(p.projector);
    return;
  }
  std::vector<int> fixed = FixedProjectorIndices(law_);
  if (offsets_free) fixed.push_back(7);  // the central order and all offsets together are a pure gauge
  if (!fixed.empty()) problem.SetManifold(p.projector, new ceres::SubsetManifold(9, fixed));
}

Eigen::MatrixXd RigFit::Covariance() {
  ceres::Problem problem;
  Build(problem, Free::kAll, false);
  if (problem.HasManifold(parameters_.projector)) problem.SetManifold(parameters_.projector, nullptr);
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = {parameters_.camera, parameters_.projector, parameters_.pose, parameters_.slide};
  ceres::CRSMatrix jacobian;
  std::vector<double> residuals;
  if (!problem.Evaluate(options, nullptr, &residuals, nullptr, &jacobian)) {
    return Eigen::MatrixXd::Zero(kAllSize, kAllSize);
  }
  constexpr double kCellsAcross = 12;
  const double cell_px = 2 * std::max(nominal_.camera[2], nominal_.camera[3]) / kCellsAcross;
  std::vector<int> cluster;
  for (const auto& view : selected_) {
    for (const OrderSample* sample : view) {
      cluster.push_back(static_cast<int>(sample->pixel.x() / cell_px) +
                        100 * static_cast<int>(sample->pixel.y() / cell_px));
    }
  }
  Eigen::MatrixXd covariance = ClusterCovariance(jacobian, residuals, cluster);
  if (misfit_is_systematic_) covariance.topLeftCorner(kBlockSizes[0], kBlockSizes[0]) = camera_covariance_;
  return covariance;
}

}  // namespace striae::reconstruct::detail
