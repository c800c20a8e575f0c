// From two registrations to angles, their uncertainties, and the report.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "analysis/head/detail/registration.h"
#include "analysis/head/measure.h"
#include "core/measurement.h"

namespace striae::head::detail {

/// rotation, flexion, tilt, total; deg.
using AngleArray = std::array<double, 4>;

/// Standard uncertainties of the four angles.
struct AngleUncertainty {
  AngleArray registration{};  ///< resampled registrations, and their floor
  AngleArray whole{};         ///< with the axes' own error
};

/// None where the pairs are too few to be resampled.
std::optional<AngleUncertainty> Uncertainties(const Fit& head, const Fit& torso,
                                              const Eigen::Matrix3d& subject_from_camera, const Options& options);

/// `rotation` = R_torso^T R_head in the neutral camera's frame; `used`: the patches' outlines, drawn or found.
AnalysisReport Report(const Fit& head, const Fit& torso, const Eigen::Matrix3d& rotation,
                      const Eigen::Matrix3d& subject_from_camera, const AngleUncertainty& sd, const Regions& used,
                      const Options& options);

/// Of a single capture: the head's rotation in the torso's anatomical axes; fits of the mirror images.
AnalysisReport AbsoluteReport(const Fit& head, const Fit& torso, const Eigen::Matrix3d& rotation_in_subject,
                              bool landmarks_given, const Options& options);

}  // namespace striae::head::detail
