// Standard uncertainties of what depends on the virtual skin.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/wound/detail/quantities.h"
#include "analysis/wound/detail/ring.h"

namespace striae::wound {

/// Covariance of a skin's coefficients from residuals that are correlated over distances: the ring is cut into square
/// blocks, and N^-1 (sum over blocks of s s^T) N^-1 with s = sum of weight * terms * residual in the block. This is the
/// limit of a wild block bootstrap with many replicates (cluster-robust "sandwich", with its small-sample factor).
struct SkinCovariance {
  Eigen::MatrixXd coefficients;
  double block_mm = 0;
  double block_mean_sd_mm = 0;  ///< sd of the residuals' means over blocks: the noise that averaging does not remove
};
SkinCovariance CovarianceOf(const Skin& skin, const Ring& ring, const RingWeights& weights, double block_mm);

/// Sd of the skin's height at one place, mm.
double HeightSd(const Skin& skin, const SkinCovariance& covariance, const Eigen::Vector2d& at);
/// Sd of the volume under the skin over the bed's triangles, mm3.
double VolumeSd(const Skin& skin, const SkinCovariance& covariance, const Bed& bed);

}  // namespace striae::wound
