// `striae healing SUBJECT`: how each wound of a subject closes over its visits.
#include "analysis/wound/healing.h"

#include <algorithm>
#include <cstdio>
#include <map>

#include "app/study.h"
#include "report/verdict.h"

namespace striae::app {
namespace {

struct Options {
  std::string subject, wound;
};

/// One wound at one visit: the values of its captures that count.
struct Day {
  std::string visit;
  Date date;
  std::vector<Measurement> area, perimeter, volume;
  std::string version;
};

struct Wound {
  std::string label;
  std::vector<Day> days;  ///< ascending
};

Result<std::vector<Wound>> Gather(store::Record& record, const Options& options) {
  const auto subject = record.SubjectByPseudonym(options.subject);
  if (!subject) return Fail(subject.error());
  store::ResultFilter filter;
  filter.subject = subject->id;
  const auto rows = record.Results(filter);
  if (!rows) return Fail(rows.error());
  std::map<std::string, std::map<std::pair<Date, std::string>, Day>> wounds;  // visits of one day stay apart
  for (const store::ResultRow& row : *rows) {
    if (row.role.kind != CaptureRole::Kind::kWound || row.excluded || row.stale || row.superseded) continue;
    if (!options.wound.empty() && row.role.label != options.wound) continue;
    const Date date = Date::Of(row.session_opened_at);
    Day& day = wounds[row.role.label][{date, row.visit.name}];
    day.visit = row.visit.name;
    day.date = date;
    day.version = row.analysis + " " + row.version;
    const std::string& name = row.measurement.name;
    if (name == "area") day.area.push_back(row.measurement);
    if (name == "perimeter") day.perimeter.push_back(row.measurement);
    if (name == "volume") day.volume.push_back(row.measurement);
  }
  std::vector<Wound> list;
  for (auto& [label, days] : wounds) {
    Wound wound{label, {}};
    for (auto& [when, day] : days) {
      if (!day.area.empty() && !day.perimeter.empty()) wound.days.push_back(std::move(day));
    }
    if (!wound.days.empty()) list.push_back(std::move(wound));
  }
  return list;
}

/// Repeats of one visit count as their mean; the uncertainty is not made smaller, for they share rig and operator.
report::Reading MeanOf(const std::vector<Measurement>& all, const std::string& version) {
  report::Reading reading;
  if (all.empty()) return reading;
  for (const Measurement& m : all) {
    reading.value += m.value / static_cast<double>(all.size());
    reading.uncertainty = std::max(reading.uncertainty, m.uncertainty);
    reading.flagged = reading.flagged || m.status == Measurement::Status::kFlagged;
  }
  reading.unit = all.front().unit;
  reading.method = version;
  return reading;
}

std::vector<wound::HealingPoint> PointsOf(const Wound& wound) {
  std::vector<wound::HealingPoint> points;
  const std::int64_t first = wound.days.front().date.DaysSinceEpoch();
  for (const Day& day : wound.days) {
    const auto area = MeanOf(day.area, day.version), perimeter = MeanOf(day.perimeter, day.version);
    points.push_back({static_cast<double>(day.date.DaysSinceEpoch() - first), area.value, area.uncertainty,
                      perimeter.value, perimeter.uncertainty});
  }
  return points;
}

nlohmann::json ToJson(const wound::Estimate& e) { return {{"value", e.value}, {"uncertainty", e.uncertainty}}; }

/// Change of a quantity since the first day, with the least change that could be detected, and the verdict.
nlohmann::json ChangeJson(const std::vector<Measurement>& first, const std::string& first_version,
                          const std::vector<Measurement>& now, const std::string& version) {
  if (first.empty() || now.empty()) return {{"verdict", "not assessable"}, {"reason", "not measured"}};
  const auto c = report::Compare(MeanOf(first, first_version), MeanOf(now, version), report::Better::kSmaller);
  nlohmann::json json = {{"verdict", std::string(ToString(c.verdict))}, {"mdc95", c.limit}};
  if (c.change) json["change"] = *c.change;
  if (c.percent) json["percent"] = *c.percent;
  if (!c.reason.empty()) json["reason"] = c.reason;
  return json;
}

nlohmann::json VisitsJson(const Wound& wound, const std::vector<wound::HealingPoint>& points) {
  nlohmann::json visits = nlohmann::json::array();
  const Day& first = wound.days.front();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Day& day = wound.days[k];
    nlohmann::json visit = {
        {"visit", day.visit},
        {"date", day.date.ToString()},
        {"day", points[k].day},
        {"captures", day.area.size()},
        {"area_cm2", {{"value", points[k].area_cm2}, {"uncertainty", points[k].area_uncertainty_cm2}}}};
    if (k > 0) {
      visit["percent_area_reduction"] = ToJson(wound::PercentAreaReduction(points[0], points[k]));
      visit["linear_healing_mm"] = ToJson(wound::LinearHealingMm(points[k - 1], points[k]));
      visit["area_change"] = ChangeJson(first.area, first.version, day.area, day.version);
      visit["volume_change"] = ChangeJson(first.volume, first.version, day.volume, day.version);
    }
    visits.push_back(visit);
  }
  return visits;
}

/// Standard error of measurement from captures of one wound on one day, where the subject has enough of them.
nlohmann::json RepeatsJson(const Wound& wound) {
  std::vector<std::vector<double>> groups;
  for (const Day& day : wound.days) {
    groups.emplace_back();
    for (const Measurement& m : day.area) groups.back().push_back(m.value);
  }
  const auto repeats = wound::RepeatabilityOf(groups);
  if (!repeats) return {{"source", "standard uncertainties of each area (too few repeated captures)"}};
  return {{"source", "repeated captures"},
          {"area_sem_cm2", repeats->sem},
          {"area_mdc95_cm2", repeats->mdc95},
          {"degrees_of_freedom", repeats->degrees_of_freedom}};
}

nlohmann::json WoundJson(const Wound& wound) {
  const auto points = PointsOf(wound);
  nlohmann::json json = {
      {"wound", wound.label}, {"visits", VisitsJson(wound, points)}, {"repeatability", RepeatsJson(wound)}};
  if (const auto fit = wound::FitExponential(points); fit) {
    json["exponential"] = {
        {"rate_per_day", ToJson(fit->rate_per_day)}, {"area0_cm2", fit->area0_cm2}, {"r_squared", fit->r_squared}};
    if (fit->half_life_day) json["exponential"]["half_life_day"] = *fit->half_life_day;
  } else {
    json["exponential"] = {{"refused", fit.error().message}};
  }
  if (const auto closure = wound::PredictClosure(points); closure) {
    json["closure"] = {{"day", closure->day},
                       {"uncertainty_day", closure->uncertainty_day},
                       {"advance_mm_per_day", ToJson(closure->advance_mm_per_day)}};
  } else {
    json["closure"] = {{"refused", closure.error().message}};
  }
  return json;
}

std::string Text(const nlohmann::json& wound) {
  std::string text = "Wound " + wound["wound"].get<std::string>() + "\n";
  char line[240];
  for (const auto& v : wound["visits"]) {
    std::snprintf(line, sizeof line, "  %-8s %s  day %4.0f  %8.2f +- %.2f cm2", v["visit"].get<std::string>().c_str(),
                  v["date"].get<std::string>().c_str(), v["day"].get<double>(), v["area_cm2"]["value"].get<double>(),
                  v["area_cm2"]["uncertainty"].get<double>());
    text += line;
    if (v.contains("percent_area_reduction")) {
      const auto& par = v["percent_area_reduction"];
      const auto& linear = v["linear_healing_mm"];
      std::snprintf(line, sizeof line, "  PAR %5.1f +- %.1f %%  edge %+.2f +- %.2f mm  %s", par["value"].get<double>(),
                    par["uncertainty"].get<double>(), linear["value"].get<double>(),
                    linear["uncertainty"].get<double>(), v["area_change"]["verdict"].get<std::string>().c_str());
      text += line;
    }
    text += '\n';
  }
  const auto& exponential = wound["exponential"];
  if (exponential.contains("rate_per_day")) {
    std::snprintf(line, sizeof line, "  exponential: k = %.4f +- %.4f a day, R2 %.3f\n",
                  exponential["rate_per_day"]["value"].get<double>(),
                  exponential["rate_per_day"]["uncertainty"].get<double>(), exponential["r_squared"].get<double>());
    text += line;
  }
  const auto& closure = wound["closure"];
  if (closure.contains("day")) {
    std::snprintf(line, sizeof line, "  the edge reaches the middle on day %.0f +- %.0f if it keeps its pace",
                  closure["day"].get<double>(), closure["uncertainty_day"].get<double>());
    return text + line;
  }
  return text + "  " + closure["refused"].get<std::string>();
}

Status Print(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto wounds = Gather(*record, options);
  if (!wounds) return Fail(wounds.error());
  if (wounds->empty()) {
    return Fail(ErrorCode::kNotFound,
                "no measured wound of " + options.subject.substr(0, 40) + "; 'striae status' says what is pending");
  }
  nlohmann::json list = nlohmann::json::array();
  std::string text;
  for (const Wound& wound : *wounds) {
    list.push_back(WoundJson(wound));
    text += (text.empty() ? "" : "\n") + Text(list.back());
  }
  run.Output({{"subject", options.subject}, {"wounds", list}}, text);
  return {};
}

}  // namespace

void AddCommand_healing(CLI::App& root, Context& context) {
  CLI::App* command =
      AddCommand(root, context, "healing", "How a subject's wounds close: area reduction, the edge's advance, closure",
                 "striae -C trial healing S001 --wound W1 --json");
  auto options = std::make_shared<Options>();
  command->add_option("subject", options->subject, "The subject's pseudonym")->required();
  command->add_option("--wound", options->wound, "Only the wound of this label");
  OnRun(command, context, [options](Context& run) { return Print(run, *options); });
}

}  // namespace striae::app
