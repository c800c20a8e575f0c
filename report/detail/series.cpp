#include "report/detail/series.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "report/quantity.h"

namespace striae::report::detail {
namespace {

using Kind = CaptureRole::Kind;

std::string SideText(Laterality laterality) {
  switch (laterality) {
    case Laterality::kLeft:
      return "left ";
    case Laterality::kRight:
      return "right ";
    case Laterality::kBilateral:
      return "both sides, ";
    case Laterality::kUnpaired:
    case Laterality::kUnspecified:
      break;
  }
  return {};
}

std::string TitleOf(const Capture& capture, int pose_number, bool several_poses) {
  std::string title;
  if (capture.role.kind == Kind::kWound) {
    title = "Wound " + capture.role.label;
    const std::string place = SideText(capture.laterality) + capture.body_site;
    return place.empty() ? title : title + ", " + place;
  }
  title = "Head position against trunk";
  return several_poses ? title + ", pose " + std::to_string(pose_number) : title;
}

/// The mean of repeated readings of one quantity in one session.
Value MeanOf(const std::vector<Value>& all) {
  std::vector<Value> used;
  std::copy_if(all.begin(), all.end(), std::back_inserter(used), [](const Value& v) { return !v.reading.flagged; });
  if (used.empty()) used = all;
  Value mean = used.front();
  if (used.size() == 1) return mean;
  const auto n = static_cast<double>(used.size());
  double sum = 0, sum_u2 = 0, sum_d2 = 0;
  std::set<std::string> reasons;
  for (const Value& v : used) {
    sum += v.reading.value;
    sum_u2 += v.reading.uncertainty * v.reading.uncertainty;
    if (!v.reason.empty()) reasons.insert(v.reason);
  }
  mean.reading.value = sum / n;
  for (const Value& v : used) sum_d2 += std::pow(v.reading.value - mean.reading.value, 2);
  // Repeats share calibration and outline: averaging does not shrink their uncertainty.
  mean.reading.uncertainty = std::max(std::sqrt(sum_u2 / n), std::sqrt(sum_d2 / (n - 1) / n));
  mean.reason.clear();
  for (const std::string& reason : reasons) mean.reason += (mean.reason.empty() ? "" : "; ") + reason;
  return mean;
}

void FillValues(SeriesColumn& column) {
  std::map<std::string, std::vector<Value>> readings;
  std::map<std::string, std::set<std::string>> left_out;  // reason -> quantities
  for (const CaptureEntry* entry : column.captures) {
    for (const AnalysisReport& report : entry->analyses) {
      for (const Measurement& m : report.measurements) {
        const bool flagged = m.status == Measurement::Status::kFlagged;
        Value value{{m.value, m.uncertainty, m.unit, flagged, report.analysis + " " + report.version}, {}};
        if (flagged) value.reason = m.reason.empty() ? "no reason was recorded" : m.reason;
        readings[m.name].push_back(value);
      }
    }
  }
  std::size_t repeats = 0;
  for (const auto& [name, all] : readings) {
    column.values[name] = MeanOf(all);
    repeats = std::max(repeats, all.size());
    if (column.values[name].reading.flagged) continue;
    for (const Value& v : all) {
      if (v.reading.flagged) left_out[v.reason].insert(name);
    }
  }
  if (repeats > 1) column.notes.push_back("mean of " + std::to_string(repeats) + " captures");
  for (const auto& [reason, names] : left_out) column.notes.push_back("a flagged repeat is left out: " + reason);
}

/// What keeps captures together: the wound's label, or the number of the pose in its session. Empty for captures
/// that carry no values of their own (neutral, no role).
std::string KeyOf(const CaptureEntry& entry, int& poses_so_far) {
  const CaptureRole& role = entry.capture.role;
  if (role.kind == Kind::kWound) return role.ToString();
  if (role.kind == Kind::kPose) return "pose:" + std::to_string(++poses_so_far);
  return {};
}

struct Keyed {
  std::string key;
  int pose_number = 0;
  Series series;
};

Keyed& FindOrAdd(std::vector<Keyed>& all, const std::string& key, int pose_number) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Keyed& k) { return k.key == key; });
  if (found != all.end()) return *found;
  all.push_back({key, pose_number, {}});
  return all.back();
}

void OrderNames(Series& series, HeadGoal goal) {
  std::set<std::string> names;
  for (const SeriesColumn& column : series.columns) {
    for (const auto& [name, value] : column.values) names.insert(name);
  }
  series.names.assign(names.begin(), names.end());
  std::stable_sort(series.names.begin(), series.names.end(), [&](const std::string& a, const std::string& b) {
    return DescribeQuantity(a, goal).order < DescribeQuantity(b, goal).order;
  });
}

}  // namespace

const SeriesColumn* Series::First(const std::string& name) const {
  const auto at = std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.values.contains(name); });
  return at == columns.end() ? nullptr : &*at;
}

const SeriesColumn* Series::Last(const std::string& name) const {
  const auto at =
      std::find_if(columns.rbegin(), columns.rend(), [&](const auto& c) { return c.values.contains(name); });
  return at == columns.rend() ? nullptr : &*at;
}

std::vector<const VisitEntry*> InOrder(const SubjectReport& subject) {
  std::vector<const VisitEntry*> visits;
  for (const VisitEntry& visit : subject.visits) visits.push_back(&visit);
  std::stable_sort(visits.begin(), visits.end(),
                   [](const auto* a, const auto* b) { return a->date.DaysSinceEpoch() < b->date.DaysSinceEpoch(); });
  return visits;
}

std::vector<Series> GatherSeries(const SubjectReport& subject) {
  const std::vector<const VisitEntry*> visits = InOrder(subject);
  const auto first = std::find_if(visits.begin(), visits.end(), [](const auto* v) { return !v->captures.empty(); });
  if (first == visits.end()) return {};
  const std::int64_t day0 = (*first)->date.DaysSinceEpoch();

  std::vector<Keyed> all;
  int most_poses = 0;
  for (const VisitEntry* visit : visits) {
    int poses = 0;
    for (const CaptureEntry& entry : visit->captures) {
      const std::string key = KeyOf(entry, poses);
      if (key.empty()) continue;
      Keyed& keyed = FindOrAdd(all, key, poses);
      auto& columns = keyed.series.columns;
      if (columns.empty() || columns.back().visit != visit) {
        columns.push_back({visit, visit->date.DaysSinceEpoch() - day0, {}, {}, {}});
      }
      columns.back().captures.push_back(&entry);
    }
    most_poses = std::max(most_poses, poses);
  }
  std::vector<Series> result;
  for (Keyed& keyed : all) {
    for (SeriesColumn& column : keyed.series.columns) FillValues(column);
    keyed.series.title =
        TitleOf(keyed.series.columns.front().captures.front()->capture, keyed.pose_number, most_poses > 1);
    OrderNames(keyed.series, subject.head_goal);
    result.push_back(std::move(keyed.series));
  }
  return result;
}

}  // namespace striae::report::detail
