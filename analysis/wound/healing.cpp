#include "analysis/wound/healing.h"

#include <cmath>

namespace striae::wound {
namespace {

constexpr double kTwoSided95 = 1.96;
constexpr std::size_t kLeastAreasForFit = 3, kLeastAreasForClosure = 5;

Status CheckPoints(std::span<const HealingPoint> points) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    const HealingPoint& p = points[k];
    if (k > 0 && !(p.day > points[k - 1].day)) {
      return Fail(ErrorCode::kUsage, "healing needs visits on ascending days; average captures of one day first");
    }
    if (!(p.area_cm2 > 0) || !(p.perimeter_mm > 0) || !(p.area_uncertainty_cm2 > 0)) {
      return Fail(
          ErrorCode::kMeasurementRefused,
          "healing rates need areas and perimeters above zero with uncertainties; a closed wound ends the series");
    }
  }
  return {};
}

struct Line {
  double at_zero = 0, slope = 0;
  double var_zero = 0, var_slope = 0, covariance = 0;
  double r_squared = 0;
};

// Weighted straight line. Where the scatter exceeds what the weights claim, the variances grow with it (Birge's ratio).
Line FitLine(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& sd) {
  double s = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double w = 1 / (sd[k] * sd[k]);
    s += w;
    sx += w * x[k];
    sy += w * y[k];
    sxx += w * x[k] * x[k];
    sxy += w * x[k] * y[k];
  }
  const double determinant = s * sxx - sx * sx;
  Line line;
  line.slope = (s * sxy - sx * sy) / determinant;
  line.at_zero = (sxx * sy - sx * sxy) / determinant;
  double chi2 = 0, total = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    chi2 += std::pow((y[k] - line.at_zero - line.slope * x[k]) / sd[k], 2);
    total += std::pow((y[k] - sy / s) / sd[k], 2);
  }
  const double birge = std::max(1.0, chi2 / static_cast<double>(x.size() - 2));
  line.var_zero = birge * sxx / determinant;
  line.var_slope = birge * s / determinant;
  line.covariance = -birge * sx / determinant;
  line.r_squared = total > 0 ? 1 - chi2 / total : 0;
  return line;
}

}  // namespace

Estimate PercentAreaReduction(const HealingPoint& first, const HealingPoint& now) {
  const double left = now.area_cm2 / first.area_cm2;
  return {100 * (1 - left),
          100 * std::hypot(now.area_uncertainty_cm2, left * first.area_uncertainty_cm2) / first.area_cm2};
}

Estimate LinearHealingMm(const HealingPoint& from, const HealingPoint& to) {
  const double perimeter = (from.perimeter_mm + to.perimeter_mm) / 2;
  const double advance = 100 * (from.area_cm2 - to.area_cm2) / perimeter;
  const double by_area = 100 * std::hypot(from.area_uncertainty_cm2, to.area_uncertainty_cm2) / perimeter;
  const double by_perimeter =
      advance * std::hypot(from.perimeter_uncertainty_mm, to.perimeter_uncertainty_mm) / 2 / perimeter;
  return {advance, std::hypot(by_area, by_perimeter)};
}

Result<ExponentialHealing> FitExponential(std::span<const HealingPoint> points) {
  if (points.size() < kLeastAreasForFit) {
    return Fail(ErrorCode::kMeasurementRefused, "an exponential needs three areas or more");
  }
  if (auto good = CheckPoints(points); !good) return Fail(good.error());
  std::vector<double> day, log_area, sd;
  for (const HealingPoint& p : points) {
    day.push_back(p.day);
    log_area.push_back(std::log(p.area_cm2));
    sd.push_back(p.area_uncertainty_cm2 / p.area_cm2);
  }
  const Line line = FitLine(day, log_area, sd);
  ExponentialHealing fit;
  fit.rate_per_day = {-line.slope, std::sqrt(line.var_slope)};
  fit.area0_cm2 = std::exp(line.at_zero);
  fit.r_squared = line.r_squared;
  if (fit.rate_per_day.value > kTwoSided95 * fit.rate_per_day.uncertainty) {
    fit.half_life_day = std::log(2) / fit.rate_per_day.value;
  }
  return fit;
}

Result<Closure> PredictClosure(std::span<const HealingPoint> points) {
  if (points.size() < kLeastAreasForClosure) {
    return Fail(ErrorCode::kMeasurementRefused,
                "no prediction of closure from " + std::to_string(points.size()) + " areas; it takes five or more");
  }
  if (auto good = CheckPoints(points); !good) return Fail(good.error());
  std::vector<double> day, radius_mm, sd;
  for (const HealingPoint& p : points) {
    day.push_back(p.day);
    radius_mm.push_back(200 * p.area_cm2 / p.perimeter_mm);
    // An outline too large is too long as well: the errors of 2 A / p are those of A alone, halved (a circle's radius).
    sd.push_back(radius_mm.back() * p.area_uncertainty_cm2 / p.area_cm2 / 2);
  }
  const Line line = FitLine(day, radius_mm, sd);
  Closure closure;
  closure.advance_mm_per_day = {-line.slope, std::sqrt(line.var_slope)};
  if (!(-line.slope > kTwoSided95 * std::sqrt(line.var_slope))) {
    return Fail(ErrorCode::kMeasurementRefused,
                "no prediction of closure: the edge does not advance by more than its uncertainty");
  }
  closure.day = line.at_zero / -line.slope;
  // First order in both coefficients of day = a / -b.
  const double da = 1 / -line.slope, db = line.at_zero / (line.slope * line.slope);
  closure.uncertainty_day =
      std::sqrt(std::max(0.0, da * da * line.var_zero + db * db * line.var_slope + 2 * da * db * line.covariance));
  const double followed = points.back().day - points.front().day;
  if (closure.day - points.back().day > followed) {
    return Fail(ErrorCode::kMeasurementRefused,
                "no prediction of closure: it lies further ahead than the wound has been followed");
  }
  return closure;
}

std::optional<Repeatability> RepeatabilityOf(const std::vector<std::vector<double>>& groups, int least) {
  double squares = 0;
  Repeatability result;
  for (const auto& group : groups) {
    if (group.size() < 2) continue;
    double mean = 0;
    for (const double v : group) mean += v / static_cast<double>(group.size());
    for (const double v : group) squares += (v - mean) * (v - mean);
    result.degrees_of_freedom += static_cast<int>(group.size()) - 1;
  }
  if (result.degrees_of_freedom < least) return std::nullopt;
  result.sem = std::sqrt(squares / result.degrees_of_freedom);
  result.mdc95 = kTwoSided95 * std::sqrt(2.0) * result.sem;
  return result;
}

}  // namespace striae::wound
