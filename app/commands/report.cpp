// `striae report`: one subject's page from the record, as HTML or PDF.
#include "report/report.h"

#include <algorithm>
#include <memory>
#include <set>

#include "app/io/files.h"
#include "app/study.h"
#include "report/page.h"

namespace striae::app {
namespace {

namespace fs = std::filesystem;
using report::CaptureEntry;
using report::SubjectReport;
using report::VisitEntry;
using store::Record;
using store::WorkItem;

struct Options {
  std::string subject;
  fs::path out;
  std::string head_goal = "posture";
};

constexpr std::size_t kShortHash = 12;

/// The newest preview of that kind; empty when there is none yet.
Result<std::vector<std::uint8_t>> Preview(Record& record, const CaptureId& capture, const char* kind) {
  const auto derived = record.LatestDerived(capture, kind);
  if (!derived) return Fail(derived.error());
  if (!*derived) return std::vector<std::uint8_t>();
  return record.ReadDerived(**derived);
}

/// Why a capture that should have numbers has none; empty when it has, or needs none.
std::string WhyNoNumbers(const WorkItem& item) {
  std::string why;
  bool measured = false;
  for (const store::Outcome& outcome : item.outcomes) {
    if (outcome.failure) why = outcome.failure->Describe();
    measured = measured || !outcome.report.measurements.empty();
  }
  if (!why.empty() || measured) return why;
  if (item.capture.role.kind == CaptureRole::Kind::kWound && !item.outline) return "no outline was drawn yet";
  return item.missing;
}

Result<CaptureEntry> Entry(Record& record, const Capture& capture, const WorkItem* item) {
  CaptureEntry entry;
  entry.capture = capture;
  if (item != nullptr) {
    for (const store::Outcome& outcome : item->outcomes) {
      if (!outcome.failure) entry.analyses.push_back(outcome.report);
    }
    entry.failure = WhyNoNumbers(*item);
  }
  auto photograph = Preview(record, capture.id, "preview-photo");
  if (!photograph) return Fail(photograph.error());
  auto depth = Preview(record, capture.id, "preview-depth");
  if (!depth) return Fail(depth.error());
  entry.photograph = *std::move(photograph);
  entry.depth_map = *std::move(depth);
  return entry;
}

void NoteRig(const WorkItem& item, std::set<std::string>& devices, std::set<std::string>& calibrations) {
  if (item.device) {
    devices.insert(item.device->model + " " + item.device->serial + ", " + std::string(ToString(item.device->range)) +
                   " range");
  }
  if (item.calibration) {
    calibrations.insert("valid from " + item.calibration->valid_from.ToString() + ", sha256 " +
                        item.calibration->sha256.ToString().substr(0, kShortHash));
  }
}

Result<SubjectReport> Gather(Record& record, const std::string& pseudonym) {
  SubjectReport all;
  auto study = record.GetStudy();
  if (!study) return Fail(study.error());
  auto subject = record.SubjectByPseudonym(pseudonym);
  if (!subject) return Fail(subject.error());
  const auto sites = record.Sites();
  if (!sites) return Fail(sites.error());
  all.study = *std::move(study);
  all.subject = *std::move(subject);
  for (const Site& site : *sites) {
    if (site.id == all.subject.site) all.site = site;
  }
  const auto sessions = record.Sessions(all.subject.id);
  if (!sessions) return Fail(sessions.error());
  std::set<std::string> devices, calibrations;
  for (const Session& session : *sessions) {
    const auto visit = record.VisitById(session.visit);
    if (!visit) return Fail(visit.error());
    const auto captures = record.Captures(session.id);
    if (!captures) return Fail(captures.error());
    const auto work = record.Work(session.id);
    if (!work) return Fail(work.error());
    VisitEntry entry;
    entry.name = visit->name;
    entry.date = Date::Of(session.opened_at);  // the day by which the record chooses the calibration
    for (const Capture& capture : *captures) {
      const auto item =
          std::find_if(work->begin(), work->end(), [&](const auto& w) { return w.capture.id == capture.id; });
      if (item != work->end()) NoteRig(*item, devices, calibrations);
      auto made = Entry(record, capture, item == work->end() ? nullptr : &*item);
      if (!made) return Fail(made.error(), "the report's part on " + capture.file_name);
      entry.captures.push_back(*std::move(made));
    }
    all.visits.push_back(std::move(entry));
  }
  all.devices.assign(devices.begin(), devices.end());
  all.calibrations.assign(calibrations.begin(), calibrations.end());
  return all;
}

nlohmann::json ToJson(const report::Section& section) {
  nlohmann::json rows = nlohmann::json::array();
  for (const report::Row& row : section.rows) {
    nlohmann::json cells = nlohmann::json::array();
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      const report::Cell& cell = row.cells[i];
      nlohmann::json out = {{"visit", section.columns[i].visit}, {"value", cell.value}, {"change", cell.change}};
      if (!cell.flag.empty()) out["flag"] = cell.flag;
      if (!cell.words.empty()) out["words"] = cell.words;
      if (cell.has_verdict) out["verdict"] = ToString(cell.verdict);
      cells.push_back(out);
    }
    rows.push_back({{"quantity", row.label}, {"unit", row.unit}, {"visits", cells}});
  }
  nlohmann::json notes = nlohmann::json::array();
  for (const report::Column& column : section.columns) {
    for (const std::string& note : column.notes) notes.push_back(column.visit + ": " + note);
  }
  return {{"title", section.title}, {"quantities", rows}, {"notes", notes}};
}

Result<std::vector<std::uint8_t>> Set(const SubjectReport& subject, bool pdf) {
  if (pdf) return report::PdfReport(subject);
  const auto html = report::HtmlReport(subject);
  if (!html) return Fail(html.error());
  return std::vector<std::uint8_t>(html->begin(), html->end());
}

Status Report(Context& context, const Options& options) {
  const bool pdf = options.out.extension() == ".pdf";
  if (!pdf && options.out.extension() != ".html") {
    return Fail(ErrorCode::kUsage,
                "'" + options.out.string() + "' is neither .html nor .pdf; end --out in one of them");
  }
  auto record = OpenStudy(context);
  if (!record) return Fail(record.error());
  auto subject = Gather(*record, options.subject);
  if (!subject) return Fail(subject.error());
  subject->software_version = std::string(StriaeVersion());
  subject->generated_at = NewStamp().now;
  subject->head_goal =
      options.head_goal == "mobility" ? report::HeadGoal::kWiderMovement : report::HeadGoal::kNearerNeutral;
  const auto bytes = Set(*subject, pdf);
  if (!bytes) return Fail(bytes.error());
  if (Status written = WriteFile(options.out, *bytes); !written) return written;

  const report::Page page = report::BuildPage(*subject);
  nlohmann::json document = {{"subject", options.subject},       {"out", options.out.string()},
                             {"format", pdf ? "pdf" : "html"},   {"sha256", HashOf(*bytes).ToString()},
                             {"visits", subject->visits.size()}, {"sections", nlohmann::json::array()},
                             {"missing", page.missing},          {"software_version", subject->software_version}};
  for (const report::Section& section : page.sections) document["sections"].push_back(ToJson(section));
  context.Output(document, options.out.string());
  return {};
}

}  // namespace

void AddCommand_report(CLI::App& root, Context& context) {
  CLI::App* command =
      AddCommand(root, context, "report", "Write a subject's measurements over the visits as HTML or PDF",
                 "striae -C trial report S001 --out S001.pdf");
  auto options = std::make_shared<Options>();
  command->add_option("SUBJECT", options->subject, "The subject's pseudonym")->required();
  command->add_option("--out", options->out, "The file, ending in .html or .pdf")->required();
  command
      ->add_option("--head-goal", options->head_goal,
                   "What is better for head angles: posture (nearer to neutral) or mobility (wider)")
      ->check(CLI::IsMember({"posture", "mobility"}))
      ->capture_default_str();
  OnRun(command, context, [options](Context& run) { return Report(run, *options); });
}

}  // namespace striae::app
