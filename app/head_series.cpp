#include "app/head_series.h"

#include <cstdio>
#include <optional>

#include "analysis/head/series.h"

namespace striae::app {
namespace {

using nlohmann::json;

json Number(std::optional<std::size_t> pose, const std::vector<std::size_t>& places) {
  return pose ? json(places[*pose] + 1) : json("neutral");
}

std::string PoseLine(std::size_t number, const HeadPose& pose) {
  std::string text = "  " + std::to_string(number) + "  " + pose.name + ": ";
  if (!pose.report) return text + "not measured, " + pose.report.error().Describe() + '\n';
  char angle[64];
  for (const Measurement& m : pose.report->measurements) {
    std::snprintf(angle, sizeof angle, "%s %.1f +- %.1f  ", m.name.c_str(), m.value, m.uncertainty);
    text += angle;
  }
  return text + '\n';
}

}  // namespace

Result<HeadSummary> SummariseHeads(const std::vector<HeadPose>& poses, std::size_t repeats) {
  std::vector<AnalysisReport> measured;
  std::vector<std::size_t> places;  // of the measured ones in the series
  std::vector<std::vector<AnalysisReport>> groups((poses.size() + repeats - 1) / repeats);
  HeadSummary summary;
  json list = json::array();
  summary.text = "Head against torso, deg (standard uncertainties):\n";
  for (std::size_t k = 0; k < poses.size(); ++k) {
    json entry = {{"pose", k + 1}, {"surface", poses[k].name}, {"repeat_of", k / repeats + 1}};
    if (poses[k].report) {
      entry.update(ToJson(*poses[k].report));
      measured.push_back(*poses[k].report);
      places.push_back(k);
      groups[k / repeats].push_back(*poses[k].report);
    } else {
      entry["refused"] = poses[k].report.error().Describe();
    }
    list.push_back(entry);
    summary.text += PoseLine(k + 1, poses[k]);
  }
  if (measured.empty()) {
    if (poses.empty()) return Fail(ErrorCode::kUsage, "no pose to measure");
    return Fail(poses.front().report.error(), "no pose of the series could be measured; the first one");
  }
  char line[160];
  json ranges = json::array(), spreads = json::array();
  summary.text += "Range of motion, the neutral pose being 0:\n";
  for (const head::Excursion& e : head::RangeOfMotion(measured)) {
    ranges.push_back({{"name", e.name},
                      {"unit", "deg"},
                      {"least", e.least_deg},
                      {"most", e.most_deg},
                      {"least_pose", Number(e.least_pose, places)},
                      {"most_pose", Number(e.most_pose, places)},
                      {"value", e.range_deg},
                      {"uncertainty", e.uncertainty_deg}});
    std::snprintf(line, sizeof line, "  %-9s %7.1f to %6.1f: %.1f +- %.1f deg\n", e.name.c_str(), e.least_deg,
                  e.most_deg, e.range_deg, e.uncertainty_deg);
    summary.text += line;
  }
  for (const head::Repeatability& r : head::PoseRepeatability(groups)) {
    if (spreads.empty()) summary.text += "Repeatability of a pose (1.96 sqrt(2) SEM = MDC95):\n";
    spreads.push_back({{"name", r.name},
                       {"unit", "deg"},
                       {"sem", r.sem_deg},
                       {"mdc95", r.mdc95_deg},
                       {"degrees_of_freedom", r.degrees_of_freedom}});
    std::snprintf(line, sizeof line, "  %-9s SEM %.2f, MDC95 %.2f deg (%zu degrees of freedom)\n", r.name.c_str(),
                  r.sem_deg, r.mdc95_deg, r.degrees_of_freedom);
    summary.text += line;
  }
  summary.text.pop_back();
  summary.document = {{"analysis", "head-series"},
                      {"version", measured.front().version},
                      {"poses", list},
                      {"range_of_motion", ranges},
                      {"repeatability", spreads}};
  return summary;
}

}  // namespace striae::app
