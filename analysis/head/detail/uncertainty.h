// What a registration's own residuals tell about its rotation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "analysis/head/detail/registration.h"

namespace striae::head::detail {

/// Resistance against being turned, mm per rad: root mean square shift of the points along the target's normals, for
/// a turn about the weakest axis after the best shift. A sphere or a plane has none.
double Observability_mm(std::span<const Pair> pairs);

/// Block bootstrap: cells of `cell_mm` are drawn with replacement and the linear step is solved again; residuals of
/// neighbours go together, so correlated noise counts as what it is. Each sample is the small rotation (rad, target's
/// frame) by which the fit would have differed. Same seed, same samples. Empty with fewer than nine cells, or when the
/// step cannot be solved.
std::vector<Eigen::Vector3d> BootstrapRotations(std::span<const Pair> pairs, double cell_mm, int resamples,
                                                std::uint64_t seed);

}  // namespace striae::head::detail
