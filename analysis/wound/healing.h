// One wound over its visits: how much it has closed, how fast, and when it may be closed. Definitions: docs/wound.md.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"

namespace striae::wound {

/// The boundary's figures at one visit; standard uncertainties.
struct HealingPoint {
  double day = 0;  ///< since the first visit; strictly ascending
  double area_cm2 = 0, area_uncertainty_cm2 = 0;
  double perimeter_mm = 0, perimeter_uncertainty_mm = 0;
};

struct Estimate {
  double value = 0, uncertainty = 0;
};

/// Percent area reduction, 100 (A0 - At) / A0, its uncertainty from both areas as independent.
Estimate PercentAreaReduction(const HealingPoint& first, const HealingPoint& now);

/// Gilman's linear advance of the edge (Wound Repair Regen 2004, 12:268): d = (A1 - A2) / ((p1 + p2) / 2), mm; for
/// circles exactly r1 - r2. Positive when the wound shrinks.
Estimate LinearHealingMm(const HealingPoint& from, const HealingPoint& to);

/// A = A0 exp(-k t), weighted least squares of ln A with the areas' relative uncertainties.
struct ExponentialHealing {
  Estimate rate_per_day;  ///< k; its uncertainty is widened by the scatter where that exceeds the areas' own
  double area0_cm2 = 0;
  double r_squared = 0;                 ///< of ln A, weighted
  std::optional<double> half_life_day;  ///< ln 2 / k, where k stands above 1.96 times its uncertainty
};
/// kMeasurementRefused for fewer than three areas or one that is not positive; kUsage for days that do not ascend.
Result<ExponentialHealing> FitExponential(std::span<const HealingPoint> points);

/// When the edge, advancing at its mean pace, reaches the middle: the effective radius 2 A / p falls linearly to 0.
struct Closure {
  double day = 0, uncertainty_day = 0;
  Estimate advance_mm_per_day;
};
/// kMeasurementRefused with the reason: fewer than five areas, an edge that does not advance beyond 1.96 standard
/// uncertainties, or a closure further ahead than the wound has been followed.
Result<Closure> PredictClosure(std::span<const HealingPoint> points);

/// Standard error of measurement from repeated captures of the same wound on the same day, and the change that it
/// makes detectable: SEM = root of the pooled variance (for pairs: SD_diff / sqrt 2), MDC95 = 1.96 sqrt 2 SEM.
struct Repeatability {
  double sem = 0, mdc95 = 0;
  int degrees_of_freedom = 0;
};
/// `groups`: the values of each wound and day. Nothing below `least` degrees of freedom: too few to trust.
std::optional<Repeatability> RepeatabilityOf(const std::vector<std::vector<double>>& groups, int least = 5);

}  // namespace striae::wound
