// From the solver's parameter blocks to the calibration, with the parameters' uncertainties.
#pragma once

#include "reconstruct/calibrate/detail/priors.h"
#include "reconstruct/calibrate/solve.h"

namespace striae::reconstruct::detail {

Calibration PackCalibration(const RigParameters& parameters, const ProjectorLaw& law, const NominalRig& nominal);

/// The covariance of the calibration's own parameters (fx for fx/fy, a0 and delta_a for the angular model) from that
/// of the solver's camera and projector (the first kRigSize). Those that the law does not have are left out.
CalibrationUncertainty PackUncertainty(const Eigen::MatrixXd& covariance, const RigParameters& parameters,
                                       const ProjectorLaw& law);

/// Values and standard uncertainties, and the pairs that are hardly told apart.
void ReportParameters(const Eigen::MatrixXd& covariance, const RigParameters& parameters, const ProjectorLaw& law,
                      std::vector<CalibrationFit::Parameter>& list,
                      std::vector<CalibrationFit::Correlation>& correlations);

}  // namespace striae::reconstruct::detail
