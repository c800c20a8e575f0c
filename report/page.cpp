#include "report/page.h"

#include <algorithm>

#include "report/detail/section.h"
#include "report/detail/series.h"
#include "report/format.h"
#include "report/quantity.h"

namespace striae::report {
namespace {

using Parts = std::vector<std::string>;

Parts OrElse(const Parts& parts, const std::string& otherwise) { return parts.empty() ? Parts{otherwise} : parts; }

Parts VisitParts(const std::vector<const VisitEntry*>& visits) {
  Parts parts;
  for (const VisitEntry* visit : visits) {
    std::string text = visit->name + " " + visit->date.ToString();
    if (!visit->missing.empty()) {
      text += " (missed)";
    } else if (!visit->status.empty()) {
      text += " (" + visit->status + ")";
    }
    parts.push_back(text);
  }
  return OrElse(parts, "none");
}

std::vector<Field> Header(const SubjectReport& subject) {
  const Study& study = subject.study;
  std::vector<Field> fields;
  if (!study.sponsor.empty()) fields.push_back({"Sponsor", {study.sponsor}});
  const Site& site = subject.site;
  fields.push_back({"Site", {site.name.empty() || site.name == site.code ? site.code : site.code + ", " + site.name}});
  fields.push_back({"Visits", VisitParts(detail::InOrder(subject))});
  fields.push_back({"Device", OrElse(subject.devices, "not recorded")});
  fields.push_back({"Calibration", OrElse(subject.calibrations, "not recorded")});
  fields.push_back({"Software", {"striae " + subject.software_version}});
  return fields;
}

std::vector<std::string> Warnings(const Subject& subject) {
  if (subject.consent_withdrawn) {
    return {"Consent was withdrawn on " + subject.consent_withdrawn->ToString() +
            ". Values from before that day are shown as they were recorded."};
  }
  if (!subject.consent_given) return {"No consent is recorded for this subject."};
  return {};
}

std::string WhyNoValue(const CaptureEntry& entry) {
  if (!entry.failure.empty()) return entry.failure;
  if (entry.capture.role.kind == CaptureRole::Kind::kUnassigned) {
    return "no role was given; say what the photograph is for (wound, neutral or pose)";
  }
  const bool carries_values = entry.capture.role.kind != CaptureRole::Kind::kNeutral;
  return carries_values && entry.analyses.empty() ? "not analysed yet" : "";
}

std::vector<std::string> Missing(const SubjectReport& subject) {
  std::vector<std::string> lines;
  for (const VisitEntry* visit : detail::InOrder(subject)) {
    const std::string where = detail::VisitText(*visit);
    if (!visit->missing.empty()) {
      lines.push_back(where + ": no captures. " + visit->missing);
    } else if (visit->captures.empty()) {
      lines.push_back(where + ": no captures.");
    }
    for (const CaptureEntry& entry : visit->captures) {
      const std::string why = WhyNoValue(entry);
      if (why.empty()) continue;
      std::string line = where + " · " + entry.capture.role.ToString();
      if (!entry.capture.file_name.empty()) line.append(" · ").append(entry.capture.file_name);
      lines.push_back(line.append(": ").append(why));
    }
  }
  return lines;
}

bool HasAngles(const std::vector<Section>& sections) {
  for (const Section& section : sections) {
    for (const Row& row : section.rows) {
      if (row.unit == "deg") return true;
    }
  }
  return false;
}

std::vector<std::string> Footer(const SubjectReport& subject, bool angles) {
  std::vector<std::string> lines = {
      "Values are given as value ± u, u the standard uncertainty (k = 1). The second line of a cell is the change d = "
      "x − "
      "x₀ against the first visit with its percentage of x₀ (left out where x₀ is itself within error of zero).",
      "Verdict: limit = 1.96 √(u² + u₀²), the minimal detectable change MDC95 = 1.96 √2 SEM with the values' own "
      "uncertainties in the place of the SEM. |d| ≤ limit: within error; beyond it improved or worse. Flagged values "
      "and values of different methods are not assessable."};
  if (angles) {
    lines.emplace_back(
        std::string("Angles: changes are of the angle's size, without its side; ") +
        (subject.head_goal == HeadGoal::kNearerNeutral ? "nearer to the neutral pose is better." : "wider is better.") +
        " Order of rotations Z-X-Y; rotation is positive to the subject's left, flexion chin towards chest, tilt to "
        "the subject's right.");
  } else {
    lines.emplace_back("Wounds: smaller is better for every quantity in the table.");
  }
  lines.emplace_back("Each depth map has a colour scale of its own, in mm from the camera.");
  return lines;
}

}  // namespace

Page BuildPage(const SubjectReport& subject) {
  Page page;
  page.title = subject.subject.pseudonym;
  page.subtitle = "Study " + subject.study.protocol;
  if (!subject.study.title.empty()) page.subtitle += ", " + subject.study.title;
  page.header = Header(subject);
  page.warnings = Warnings(subject.subject);
  const std::vector<detail::Series> all = detail::GatherSeries(subject);
  const auto has_values = [](const detail::Series& series) { return !series.names.empty(); };
  const bool any_values = std::any_of(all.begin(), all.end(), has_values);
  for (const detail::Series& series : all) {
    // Without a single value it has no table and no plot; why is said under "Missing and failed".
    if (any_values && !has_values(series)) continue;
    page.sections.push_back(detail::MakeSection(series, subject.head_goal));
  }
  page.missing = Missing(subject);
  page.footer = Footer(subject, HasAngles(page.sections));
  page.generated = MinuteText(subject.generated_at.ToString()) + " by striae " + subject.software_version;
  return page;
}

}  // namespace striae::report
