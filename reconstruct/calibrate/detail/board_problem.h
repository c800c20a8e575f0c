// The least-squares problem of the board calibration: corners in pixels and stripe orders on the board's planes.
#pragma once

#include <vector>

#include "reconstruct/calibrate/board.h"
#include "reconstruct/calibrate/detail/board_corners.h"
#include "reconstruct/calibrate/detail/priors.h"

namespace striae::reconstruct::detail {

/// Which parameters a solution frees: camera and poses by the corners alone; the projector by the orders with them
/// held; everything.
enum class BoardFree { kCameraAndPoses, kProjector, kAll };

class BoardProblem {
 public:
  BoardProblem(const std::vector<BoardView>& views, const RigParameters& nominal, int axis);

  /// Poses from the corners with the nominal camera; kBadCalibration where they lie on no plane.
  Status FindPoses();
  /// One solution; false when it failed.
  bool Solve(BoardFree free, bool offsets_free, int iterations);
  /// The first sheet's offset of every photograph: the median difference.
  void GuessOffsets();
  /// Adds every sheet whose differences agree on a whole number to the first.
  void JoinSheets();
  /// From here on corners and orders weigh by what most of them show.
  void LearnSigmas();

  /// Measured minus predicted order of the samples in use, stripes; as depth along the ray, mm.
  [[nodiscard]] std::vector<double> Differences(std::size_t view) const;
  [[nodiscard]] std::vector<double> DepthDifferences(std::size_t view) const;
  [[nodiscard]] double CornerRms(std::size_t view) const;
  /// Camera and projector (kRigSize), poses free; a cell of the field in one photograph counts once.
  [[nodiscard]] Eigen::MatrixXd Covariance();

  RigParameters& parameters() { return parameters_; }
  [[nodiscard]] const RigParameters& nominal() const { return nominal_; }
  [[nodiscard]] const ProjectorLaw& law() const { return law_; }
  std::vector<double>& offsets() { return offsets_; }
  [[nodiscard]] const BoardPose& pose(std::size_t view) const { return poses_[view]; }
  [[nodiscard]] std::size_t SamplesIn(std::size_t view) const { return samples_[view].size(); }

 private:
  void Build(ceres::Problem& problem, BoardFree free, bool offsets_free);

  const std::vector<BoardView>& views_;
  RigParameters nominal_, parameters_;
  ProjectorLaw law_;
  std::vector<BoardPose> poses_;
  std::vector<double> offsets_;
  std::vector<std::vector<OrderSample>> samples_;
  /// An edge in a dark stripe is not seen: across the stripes corners are known to a quarter of a stripe only.
  Eigen::Vector2d sigma_px_{0.5, 0.5};
  double sigma_stripes_ = 0.03;
};

}  // namespace striae::reconstruct::detail
