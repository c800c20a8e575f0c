#include "analysis/head/series.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace striae::head {
namespace {

constexpr const char* kAngles[] = {"rotation", "flexion", "tilt"};

const Measurement& AngleOf(const AnalysisReport& report, const char* name) {
  const Measurement* angle = report.Find(name);
  if (angle == nullptr) throw std::logic_error(std::string("a report of a head without ") + name);
  return *angle;
}

}  // namespace

std::vector<Excursion> RangeOfMotion(std::span<const AnalysisReport> poses) {
  std::vector<Excursion> found;
  for (const char* name : kAngles) {
    Excursion excursion{name, 0, 0, {}, {}, 0, 0};
    double least_u = 0, most_u = 0;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const Measurement& angle = AngleOf(poses[k], name);
      if (angle.value < excursion.least_deg) {
        excursion.least_deg = angle.value;
        excursion.least_pose = k;
        least_u = angle.uncertainty;
      }
      if (angle.value > excursion.most_deg) {
        excursion.most_deg = angle.value;
        excursion.most_pose = k;
        most_u = angle.uncertainty;
      }
    }
    excursion.range_deg = excursion.most_deg - excursion.least_deg;
    excursion.uncertainty_deg = std::hypot(least_u, most_u);
    found.push_back(excursion);
  }
  return found;
}

std::vector<Repeatability> PoseRepeatability(std::span<const std::vector<AnalysisReport>> groups) {
  std::vector<Repeatability> found;
  for (const char* name : kAngles) {
    double squares = 0;
    std::size_t freedom = 0;
    for (const std::vector<AnalysisReport>& group : groups) {
      if (group.size() < 2) continue;
      double mean = 0;
      for (const AnalysisReport& report : group)
        mean += AngleOf(report, name).value / static_cast<double>(group.size());
      for (const AnalysisReport& report : group) squares += std::pow(AngleOf(report, name).value - mean, 2);
      freedom += group.size() - 1;
    }
    if (freedom == 0) return {};
    const double sem = std::sqrt(squares / static_cast<double>(freedom));
    found.push_back({name, sem, 1.96 * std::numbers::sqrt2 * sem, freedom});
  }
  return found;
}

}  // namespace striae::head
