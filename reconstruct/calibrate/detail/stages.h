// The order in which the reference-object calibration frees its parameters, by least squares or by Powell's method.
#pragma once

#include <vector>

#include "reconstruct/calibrate/detail/rig_fit.h"

namespace striae::reconstruct::detail {

/// From shape alone (real offsets) through rounding to the last solution; the residuals' sd before and after rounding.
struct Solved {
  std::vector<double> distances;  ///< of each offset from a whole number
  double sd_free = 0, sd_fixed = 0;
};

/// kBadCalibration when a solution fails. `fit` has the solution.
Result<Solved> SolveByLeastSquares(RigFit& fit, const SolveOptions& options);

/// The paper's way: Powell's method without derivatives (Brent's PRAXIS, NLopt) on the sd of the depth differences
/// between measured and reference surface, mm. Begins where SolveByLeastSquares begins; while the whole stripes are
/// open, every photograph has an offset of its own, which has a closed form. Ends when the sd changes by less than 1e-6
/// of itself or after a fixed number of evaluations: the same result in every run.
Result<Solved> SolveByPowell(RigFit& fit, const SolveOptions& options);

/// After whole stripes are known: the same for another projector law, from its nominal values.
bool RefineByLeastSquares(RigFit& fit, const SolveOptions& options);
bool RefineByPowell(RigFit& fit, const SolveOptions& options);

}  // namespace striae::reconstruct::detail
