// Pairs of points, and how much each of them says about a motion.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "analysis/head/detail/registration.h"

namespace striae::head::detail {

/// Inverse variances from both points' own uncertainties `sd_mm` (of the pair), times Tukey's biweight of the residuals
/// over them: its scale is their median absolute deviation, so that the many decide what disagrees. Sets `weight` of
/// each pair; returns the mean biweight.
double WeighRobustly(std::span<Pair> pairs, std::span<const double> sd_mm);

/// The same weight for all but the worst tenth, which has none.
void WeighTrimmed(std::span<Pair> pairs);

/// One step of weighted point-to-plane least squares, about the middle of the pairs.
Eigen::Isometry3d SolveStep(std::span<const Pair> pairs);

}  // namespace striae::head::detail
