// The least-squares problem of the reference-object calibration: samples, residuals and one Ceres solution after
// another.
#pragma once

#include <vector>

#include "reconstruct/calibrate/detail/order_residual.h"
#include "reconstruct/calibrate/detail/priors.h"
#include "reconstruct/calibrate/solve.h"

namespace striae::reconstruct::detail {

enum class Free { kPose, kPoseSlideProjector, kAll };

class RigFit {
 public:
  RigFit(const ReferenceShape& shape, const std::vector<CalibrationView>& views, const RigParameters& nominal,
         const ProjectorLaw& law)
      : shape_(shape), views_(views), nominal_(nominal), parameters_(nominal), law_(law), offsets_(views.size(), 0.0) {}

  RigParameters& parameters() { return parameters_; }
  [[nodiscard]] const RigParameters& parameters() const { return parameters_; }
  [[nodiscard]] const RigParameters& nominal() const { return nominal_; }
  [[nodiscard]] const ProjectorLaw& law() const { return law_; }
  [[nodiscard]] bool misfit_is_systematic() const { return misfit_is_systematic_; }
  std::vector<double>& offsets() { return offsets_; }
  [[nodiscard]] const std::vector<double>& offsets() const { return offsets_; }

  /// From here on another law that does not have the rig's shape, from `start`; beliefs are about `nominal`. The camera
  /// stays as it has been found. The misfit is systematic: plain least squares, its samples count as a few.
  void ChangeLaw(const ProjectorLaw& law, const RigParameters& nominal, const RigParameters& start);

  /// Takes the samples that the present estimate sees on the usable part of the reference.
  void SelectSamples(std::size_t most_per_view);
  [[nodiscard]] std::size_t SelectedIn(std::size_t view) const { return selected_[view].size(); }

  /// First guess of every photograph's offset: the median difference.
  void GuessOffsets();

  /// One solution; false when it failed.
  bool Solve(Free free, bool offsets_free, int iterations);

  /// From here on samples weigh by the noise that most of them show (1.4826 times the median residual).
  void LearnSigma();

  /// Measured minus predicted order of every selected sample of a view, stripes.
  [[nodiscard]] std::vector<double> Differences(std::size_t view) const;
  /// The same as depth along the ray (to first order), with what a stripe is worth there.
  struct DepthDifference {
    double mm = 0, mm_per_stripe = 0;
  };
  [[nodiscard]] std::vector<DepthDifference> DepthDifferences(const RigParameters& at, std::size_t view) const;

  /// sd of Differences in one view and over all, stripes.
  [[nodiscard]] double ViewSpread(std::size_t view) const;
  [[nodiscard]] double Spread() const;

  /// Covariance of all parameters (camera, projector, pose, slide; kAllSize) at the solution, offsets fixed; zero rows
  /// for those that the law does not have, all zeros where it cannot be inverted. What the model leaves (the Fourier
  /// window on rims, the field's border) is alike over neighbouring pixels and in all photographs, so residuals are
  /// summed over cells of the field before they are taken as independent (cluster-robust sandwich; Liang and Zeger,
  /// Biometrika 73, 1986).
  [[nodiscard]] Eigen::MatrixXd Covariance();

 private:
  void Build(ceres::Problem& problem, Free free, bool offsets_free);

  const ReferenceShape& shape_;
  const std::vector<CalibrationView>& views_;
  RigParameters nominal_, parameters_;
  ProjectorLaw law_;
  std::vector<double> offsets_;
  std::vector<std::vector<const OrderSample*>> selected_;
  double sigma_stripes_ = 0.01;
  bool misfit_is_systematic_ = false;
  Eigen::MatrixXd camera_covariance_;  ///< of the law before
};

/// Delete-one-cluster jackknife, to first order: the sum over the G clusters of (G - 1) / G d d', where leaving a
/// cluster out moves the parameters by d = inverse(J'J - its J'J) (its score), and the priors' part. Unlike the
/// sandwich it counts the leverage of the few clusters at the field's border. The first `cluster.size()` rows of the
/// Jacobian are samples, the rest priors. Columns without a derivative have zeros.
Eigen::MatrixXd ClusterCovariance(const ceres::CRSMatrix& jacobian, const std::vector<double>& residuals,
                                  const std::vector<int>& cluster);

}  // namespace striae::reconstruct::detail
