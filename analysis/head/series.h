// Several poses of one person against one neutral capture: the range of motion, and how well a pose is repeated.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/measurement.h"
#include "core/result.h"

namespace striae::head {

/// How far one angle went to either side over all poses; the neutral pose itself counts as 0 deg.
struct Excursion {
  std::string name;  ///< rotation, flexion or tilt
  double least_deg = 0, most_deg = 0;
  std::optional<std::size_t> least_pose, most_pose;  ///< which of the poses; none where it is the neutral one
  double range_deg = 0;                              ///< most - least
  /// Standard uncertainty of the range, both ends taken as independent, with that of the axes.
  double uncertainty_deg = 0;
};

/// One for each of rotation, flexion and tilt. The reports are of Measure against the same neutral capture.
/// std::logic_error for a report without these angles.
std::vector<Excursion> RangeOfMotion(std::span<const AnalysisReport> poses);

/// The spread of one angle when one pose is taken again and again.
struct Repeatability {
  std::string name;
  double sem_deg = 0;                  ///< standard error of measurement: the pooled sd within the poses
  double mdc95_deg = 0;                ///< smallest change that is one with 95 % confidence: 1.96 sqrt(2) SEM
  std::size_t degrees_of_freedom = 0;  ///< below about 10 the SEM itself is known to a quarter at best
};

/// `groups`: captures of one pose each; groups of one say nothing and are passed over. For two captures of every pose
/// SEM^2 is half the mean squared difference. One for each of rotation, flexion and tilt, and none when no pose was
/// repeated.
std::vector<Repeatability> PoseRepeatability(std::span<const std::vector<AnalysisReport>> groups);

}  // namespace striae::head
