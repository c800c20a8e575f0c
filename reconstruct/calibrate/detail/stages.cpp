#include "reconstruct/calibrate/detail/stages.h"

#include "reconstruct/calibrate/detail/orders.h"

namespace striae::reconstruct::detail {
namespace {
constexpr std::size_t kFew = 700, kMany = 2500, kMost = 6000;
constexpr std::size_t kForMisfit = 1500;  ///< a misfit that is smooth over the field needs no more

void Tell(const SolveOptions& options, double share, const char* what) {
  if (options.progress) options.progress(share, what);
}
}  // namespace

Result<Solved> SolveByLeastSquares(RigFit& fit, const SolveOptions& options) {
  const auto failed = [] {
    return Fail(ErrorCode::kBadCalibration,
                "these photographs cannot calibrate the rig: the fit did not converge; check the mesh's unit and axes "
                "and the steps' signs");
  };
  Tell(options, 0, "pose of the object");
  fit.SelectSamples(kFew);
  fit.GuessOffsets();
  if (!fit.Solve(Free::kPose, true, 30)) return failed();
  Tell(options, 0.1, "slide and projector");
  fit.SelectSamples(kFew);
  if (!fit.Solve(Free::kPoseSlideProjector, true, 40)) return failed();
  Tell(options, 0.2, "all parameters");
  fit.SelectSamples(kFew);
  if (!fit.Solve(Free::kAll, true, 60)) return failed();
  fit.SelectSamples(kMany);
  if (!fit.Solve(Free::kAll, true, 60)) return failed();
  Tell(options, 0.5, "whole stripes");
  Solved solved;
  solved.sd_free = fit.Spread();
  const Settled settled = SettleOffsets(fit.offsets());
  solved.distances = settled.distance;
  fit.offsets() = settled.whole;
  fit.parameters().projector[7] -= settled.fraction;
  if (!fit.Solve(Free::kAll, false, 60)) return failed();
  solved.sd_fixed = fit.Spread();
  if (!RefineByLeastSquares(fit, options)) return failed();
  return solved;
}

bool RefineByLeastSquares(RigFit& fit, const SolveOptions& options) {
  fit.SelectSamples(fit.misfit_is_systematic() ? kForMisfit : kMost);
  for (int round = 0; round < 2; ++round) {
    Tell(options, 0.6 + 0.2 * round, "last weights");
    fit.LearnSigma();
    if (!fit.Solve(Free::kAll, false, 60)) return false;
  }
  return true;
}

}  // namespace striae::reconstruct::detail
