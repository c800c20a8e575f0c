#include "reconstruct/calibrate/detail/board_problem.h"

#include <algorithm>
#include <cmath>

#include <ceres/ceres.h>

#include "reconstruct/calibrate/detail/rig_fit.h"

namespace striae::reconstruct::detail {
namespace {

constexpr double kLoss = 2;
constexpr double kFinest_px = 0.02, kFinest_stripes = 0.001;

struct CornerResidual {
  template <typename T>
  bool operator()(const T* camera, const T* pose, T* residual) const {
    const T on_board[3] = {T(corner.on_board_mm.x()), T(corner.on_board_mm.y()), T(0.0)};
    T point[3];
    ceres::AngleAxisRotatePoint(pose, on_board, point);
    const T x = (point[0] + pose[3]) / (point[2] + pose[5]), y = (point[1] + pose[4]) / (point[2] + pose[5]);
    const T r2 = x * x + y * y, radial = 1.0 + r2 * (camera[4] + r2 * camera[5]);
    residual[0] = (camera[0] * camera[1] * x * radial + camera[2] - corner.pixel.x()) / sigma_px[0];
    residual[1] = (camera[0] * y * radial + camera[3] - corner.pixel.y()) / sigma_px[1];
    return true;
  }
  BoardCorner corner;
  Eigen::Vector2d sigma_px;
};

/// Where a pixel's ray meets the board's plane, camera frame.
template <typename T>
void PointOnBoard(const T* camera, const T* pose, const Eigen::Vector2d& pixel, T* point) {
  T ray[3], normal[3];
  UndistortedRay(camera, pixel, ray);
  const T z[3] = {T(0.0), T(0.0), T(1.0)};
  ceres::AngleAxisRotatePoint(pose, z, normal);
  const T distance = normal[0] * pose[3] + normal[1] * pose[4] + normal[2] * pose[5];
  const T depth = distance / (normal[0] * ray[0] + normal[1] * ray[1] + normal[2] * ray[2]);
  for (int i = 0; i < 3; ++i) point[i] = depth * ray[i];
}

struct PlaneResidual {
  template <typename T>
  bool operator()(const T* camera, const T* projector, const T* pose, const T* offset, T* residual) const {
    T point[3];
    PointOnBoard(camera, pose, sample.pixel, point);
    residual[0] = (sample.order + offset[0] - OrderOf(law, projector, point)) / sigma;
    return true;
  }
  ProjectorLaw law;
  OrderSample sample;
  double sigma;
};

double MedianOf(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

BoardProblem::BoardProblem(const std::vector<BoardView>& views, const RigParameters& nominal, int axis)
    : views_(views),
      nominal_(nominal),
      parameters_(nominal),
      law_{ProjectorModel::Kind::kPinhole, axis},
      poses_(views.size()),
      offsets_(views.size(), 0.0) {
  for (const BoardView& view : views)
    samples_.push_back(view.sheets.empty() ? std::vector<OrderSample>() : view.sheets[0].samples);
}

Status BoardProblem::FindPoses() {
  const RigParameters& p = parameters_;
  const CameraModel camera{p.camera[0] * p.camera[1], p.camera[0], p.camera[2], p.camera[3], 0, 0, 0, 0};
  for (std::size_t v = 0; v < views_.size(); ++v) {
    auto pose = PoseFromCorners(views_[v].corners, camera);
    if (!pose) return Fail(pose.error(), "photograph " + std::to_string(v + 1));
    poses_[v] = *pose;
  }
  return {};
}

std::vector<double> BoardProblem::Differences(std::size_t v) const {
  std::vector<double> differences;
  for (const OrderSample& sample : samples_[v]) {
    double point[3];
    PointOnBoard(parameters_.camera, poses_[v].values, sample.pixel, point);
    differences.push_back(sample.order + offsets_[v] - OrderOf(law_, parameters_.projector, point));
  }
  return differences;
}

std::vector<double> BoardProblem::DepthDifferences(std::size_t v) const {
  constexpr double kStep = 1e-4;
  std::vector<double> differences;
  for (const OrderSample& sample : samples_[v]) {
    double point[3];
    PointOnBoard(parameters_.camera, poses_[v].values, sample.pixel, point);
    const double behind[3] = {(1 + kStep) * point[0], (1 + kStep) * point[1], (1 + kStep) * point[2]};
    const double here = OrderOf(law_, parameters_.projector, point);
    const double per_mm = (OrderOf(law_, parameters_.projector, behind) - here) / (kStep * point[2]);
    differences.push_back((sample.order + offsets_[v] - here) / per_mm);
  }
  return differences;
}

double BoardProblem::CornerRms(std::size_t v) const {
  double sum = 0;
  for (const BoardCorner& corner : views_[v].corners) {
    double residual[2];
    CornerResidual{corner, {1, 1}}(parameters_.camera, poses_[v].values, residual);
    sum += residual[0] * residual[0] + residual[1] * residual[1];
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, views_[v].corners.size())));
}

void BoardProblem::GuessOffsets() {
  for (std::size_t v = 0; v < views_.size(); ++v) offsets_[v] -= MedianOf(Differences(v));
}

void BoardProblem::JoinSheets() {
  constexpr double kLargestRemainder = 0.15;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    for (std::size_t s = 1; s < views_[v].sheets.size(); ++s) {
      const std::vector<OrderSample>& sheet = views_[v].sheets[s].samples;
      std::vector<double> differences;
      for (const OrderSample& sample : sheet) {
        double point[3];
        PointOnBoard(parameters_.camera, poses_[v].values, sample.pixel, point);
        differences.push_back(OrderOf(law_, parameters_.projector, point) - offsets_[v] - sample.order);
      }
      const double shift = MedianOf(std::move(differences)), whole = std::round(shift);
      if (std::abs(shift - whole) > kLargestRemainder) continue;
      for (const OrderSample& sample : sheet) samples_[v].push_back({sample.pixel, sample.order + whole});
    }
  }
}

void BoardProblem::LearnSigmas() {
  std::vector<double> pixels[2], stripes;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    for (const BoardCorner& corner : views_[v].corners) {
      double residual[2];
      CornerResidual{corner, {1, 1}}(parameters_.camera, poses_[v].values, residual);
      for (int i = 0; i < 2; ++i) pixels[i].push_back(std::abs(residual[i]));
    }
    for (const double difference : Differences(v)) stripes.push_back(std::abs(difference));
  }
  for (int i = 0; i < 2; ++i) sigma_px_[i] = std::clamp(1.4826 * MedianOf(std::move(pixels[i])), kFinest_px, 5.0);
  sigma_stripes_ = std::clamp(1.4826 * MedianOf(std::move(stripes)), kFinest_stripes, 0.1);
}

void BoardProblem::Build(ceres::Problem& problem, BoardFree free, bool offsets_free) {
  RigParameters& p = parameters_;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    for (const BoardCorner& corner : views_[v].corners) {
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<CornerResidual, 2, 6, 6>(new CornerResidual{corner, sigma_px_}),
          new ceres::CauchyLoss(kLoss), p.camera, poses_[v].values);
    }
    if (free == BoardFree::kCameraAndPoses) continue;
    for (const OrderSample& sample : samples_[v]) {
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PlaneResidual, 1, 6, 9, 6, 1>(
                                   new PlaneResidual{law_, sample, sigma_stripes_}),
                               new ceres::CauchyLoss(kLoss), p.camera, p.projector, poses_[v].values, &offsets_[v]);
    }
    if (!offsets_free) problem.SetParameterBlockConstant(&offsets_[v]);
    if (free == BoardFree::kProjector) problem.SetParameterBlockConstant(poses_[v].values);
  }
  std::vector<Prior> priors = Priors(nominal_, law_, false);
  if (free == BoardFree::kCameraAndPoses) {
    priors.erase(std::remove_if(priors.begin(), priors.end(), [](const Prior& q) { return q.block != kCameraBlock; }),
                 priors.end());
  }
  AddPriors(priors, nominal_, parameters_, problem);
  if (free == BoardFree::kProjector) problem.SetParameterBlockConstant(p.camera);
  if (free != BoardFree::kCameraAndPoses && offsets_free) {
    problem.SetManifold(p.projector, new ceres::SubsetManifold(9, {7}));  // the gauge
  }
}

bool BoardProblem::Solve(BoardFree free, bool offsets_free, int iterations) {
  ceres::Problem problem;
  Build(problem, free, offsets_free);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = iterations;
  options.num_threads = 1;  // sums in one order: the same bytes on every machine
  options.logging_type = ceres::SILENT;
  options.function_tolerance = 1e-8;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.IsSolutionUsable();
}

Eigen::MatrixXd BoardProblem::Covariance() {
  ceres::Problem problem;
  Build(problem, BoardFree::kAll, false);
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = {parameters_.camera, parameters_.projector};
  for (BoardPose& pose : poses_) options.parameter_blocks.push_back(pose.values);
  ceres::CRSMatrix jacobian;
  std::vector<double> residuals;
  if (!problem.Evaluate(options, nullptr, &residuals, nullptr, &jacobian)) {
    return Eigen::MatrixXd::Zero(kRigSize, kRigSize);
  }
  const double cell_px = std::max(nominal_.camera[2], nominal_.camera[3]) / 3;
  std::vector<int> cluster;
  int own = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    for (std::size_t i = 0; i < views_[v].corners.size(); ++i, ++own) cluster.insert(cluster.end(), 2, own + 1000000);
    for (const OrderSample& sample : samples_[v]) {
      cluster.push_back(static_cast<int>(v) * 10000 + static_cast<int>(sample.pixel.x() / cell_px) +
                        100 * static_cast<int>(sample.pixel.y() / cell_px));
    }
  }
  return ClusterCovariance(jacobian, residuals, cluster);
}

}  // namespace striae::reconstruct::detail
