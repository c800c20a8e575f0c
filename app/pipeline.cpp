#include "app/pipeline.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "analysis/head/measure.h"
#include "analysis/wound/wound.h"
#include "app/device_checks.h"
#include "app/kept_surface.h"
#include "app/session_label.h"
#include "app/study.h"

namespace striae::app {
namespace {

using store::Outcome;
using store::Record;
using store::WorkItem;

std::string AnalysisOf(const CaptureRole& role) {
  switch (role.kind) {
    case CaptureRole::Kind::kWound:
      return "wound";
    case CaptureRole::Kind::kPose:
      return "head";
    default:
      return kSurfaceKind;
  }
}

constexpr const char* kDeviceCheck = "device check";
constexpr const char* kForeignLabel = "label of another session";

/// Why what is measured on a capture is not trusted, beside what the surface itself says.
struct Doubts {
  std::optional<store::Doubt> device;
  std::optional<ForeignLabel> label;
};

/// Whether the doubts that a result was flagged with are those that there are now.
bool SameDoubts(const Provenance& provenance, const std::vector<ProvenanceInput>& sources) {
  const auto doubts = [](const std::vector<ProvenanceInput>& inputs) {
    return std::count_if(inputs.begin(), inputs.end(),
                         [](const ProvenanceInput& i) { return i.name == kDeviceCheck || i.name == kForeignLabel; });
  };
  return doubts(provenance.inputs) == doubts(sources);
}

/// The neutral pose that a pose is measured against: the newest of the same session, else of the subject's latest
/// session before it.
const WorkItem* NeutralFor(const WorkItem& pose, const std::vector<WorkItem>& all) {
  const WorkItem* best = nullptr;
  const auto rank = [&](const WorkItem& item) {
    return std::tuple(item.session.id == pose.session.id, item.session.opened_at, item.capture.imported_at);
  };
  for (const WorkItem& item : all) {
    if (item.capture.role.kind != CaptureRole::Kind::kNeutral || item.subject.id != pose.subject.id) continue;
    if (item.session.opened_at > pose.session.opened_at) continue;
    if (best == nullptr || rank(item) > rank(*best)) best = &item;
  }
  return best;
}

/// An error of the record or the disk, which ends the whole run; anything else is an outcome of the one capture.
bool EndsTheRun(const Error& error) {
  return error.code == ErrorCode::kIo || error.code == ErrorCode::kRecordDamaged || error.code == ErrorCode::kInternal;
}

std::string Summary(const AnalysisReport& report) {
  std::string text;
  for (const char* name : {"volume", "area", "depth_max", "rotation", "flexion", "tilt"}) {
    const Measurement* m = report.Find(name);
    if (m == nullptr) continue;
    const char* flag = m->status == Measurement::Status::kFlagged ? " (flagged)" : "";
    text += fmt::format("{}{} {:.2f} +- {:.2f} {}{}", text.empty() ? "" : ", ", m->name, m->value, m->uncertainty,
                        m->unit, flag);
  }
  return text;
}

/// Works through one study's captures; each outcome goes into the record as soon as it is known.
class Run {
 public:
  Run(Record& record, std::vector<WorkItem> all) : record_(record), all_(std::move(all)) {}

  Result<Processed> Process(const WorkItem& item) {
    Processed processed{Processed::State::kFailed, item.capture, AnalysisOf(item.capture.role), {}, {}};
    auto sources = SourcesOf(item);
    Doubts doubts;
    // First of all, so that a wrong patient is named before anybody draws an outline.
    auto label = ForeignLabelIn(record_, item);
    if (!label) return Fail(label.error());
    doubts.label = *std::move(label);
    if (doubts.label) {
      processed.warning = doubts.label->reason;
      if (const Status noted = NoteDeviation(record_, item, *doubts.label); !noted) return Fail(noted.error());
      sources.push_back({kForeignLabel, doubts.label->evidence});
    }
    const WorkItem* neutral = nullptr;
    if (processed.analysis == "wound") {
      if (!item.outline) return Waiting(processed, "no outline yet; add it with: striae outline CAPTURE outline.json");
      sources.push_back({"outline", item.outline->sha256});
    } else if (processed.analysis == "head") {
      neutral = NeutralFor(item, all_);
      if (neutral == nullptr) {
        return Waiting(processed, "no neutral pose of this subject yet; import it with: striae import --as neutral");
      }
      sources.push_back({"neutral photograph", neutral->capture.sha256});
    }
    // A neutral pose in doubt puts every pose that is measured against it in doubt.
    if (neutral != nullptr && !doubts.label) {
      auto of_neutral = ForeignLabelIn(record_, *neutral);
      if (!of_neutral) return Fail(of_neutral.error());
      doubts.label = *std::move(of_neutral);
      if (doubts.label) {
        doubts.label->reason = "the neutral photograph: " + doubts.label->reason;
        sources.push_back({kForeignLabel, doubts.label->evidence});
      }
    }
    auto doubt = DoubtAbout(record_, item);
    if (doubt && !*doubt && neutral != nullptr) doubt = DoubtAbout(record_, *neutral);
    if (!doubt) return Fail(doubt.error());
    doubts.device = *std::move(doubt);
    if (doubts.device) sources.push_back({kDeviceCheck, doubts.device->evidence});
    if (const Outcome* known = InForce(item, processed.analysis);
        known && SameSources(known->report.provenance, sources) && SameDoubts(known->report.provenance, sources)) {
      processed.state = known->failure ? Processed::State::kFailed : Processed::State::kUpToDate;
      processed.text = known->failure ? known->failure->Describe() : Summary(known->report);
      return processed;
    }
    return Measure(item, neutral, sources, doubts, processed);
  }

 private:
  static Processed Waiting(Processed processed, const std::string& why) {
    processed.state = Processed::State::kWaiting;
    processed.text = why;
    return processed;
  }

  static const Outcome* InForce(const WorkItem& item, const std::string& analysis) {
    for (const Outcome& outcome : item.outcomes) {
      if (outcome.analysis == analysis) return &outcome;
    }
    return nullptr;
  }

  Result<Processed> Measure(const WorkItem& item, const WorkItem* neutral, const std::vector<ProvenanceInput>& sources,
                            const Doubts& doubts, Processed processed) {
    auto surface = SurfaceOf(record_, item);
    if (!surface) return Failed(item, sources, surface.error(), processed);
    if (processed.analysis == kSurfaceKind) {
      processed.state = Processed::State::kSurfaceOnly;
      processed.text = fmt::format("surface of {} points", surface->surface.size());
      return processed;
    }
    auto inputs = sources;
    inputs.push_back({"surface", surface->sha256});
    auto report = neutral == nullptr ? wound::Measure(surface->surface, item.outline->outline)
                                     : MeasureHead(*neutral, surface->surface, inputs);
    if (!report) return Failed(item, sources, report.error(), processed);
    report->provenance.version = std::string(StriaeVersion());
    report->provenance.inputs = inputs;
    for (const std::string& warning : Warnings(surface->surface)) FlagAll(*report, "the surface: " + warning);
    if (doubts.label) FlagAll(*report, doubts.label->reason);
    if (doubts.device) Flag(*report, *doubts.device);
    const auto added = record_.AddReport(NewId<ReportId>(), item.capture.id, *report, NewStamp());
    if (!added) return Fail(added.error());
    processed.state = Processed::State::kMeasured;
    processed.text = Summary(*report);
    return processed;
  }

  Result<AnalysisReport> MeasureHead(const WorkItem& neutral, const Surface& pose,
                                     std::vector<ProvenanceInput>& inputs) {
    const auto surface = SurfaceOf(record_, neutral);
    if (!surface) return Fail(surface.error(), "the neutral pose " + neutral.capture.file_name);
    inputs.push_back({"neutral surface", surface->sha256});
    auto report = head::Measure(surface->surface, pose);
    if (!report) return Fail(report.error());
    for (const std::string& warning : Warnings(surface->surface)) FlagAll(*report, "the neutral surface: " + warning);
    return report;
  }

  Result<Processed> Failed(const WorkItem& item, const std::vector<ProvenanceInput>& sources, const Error& error,
                           Processed processed) {
    if (EndsTheRun(error)) return Fail(error);
    AnalysisReport report;
    report.analysis = processed.analysis;
    report.version = "0";
    report.provenance = NewProvenance(sources);
    const auto added = record_.AddFailure(NewId<ReportId>(), item.capture.id, report, error, NewStamp());
    if (!added) return Fail(added.error());
    processed.text = error.Describe();
    return processed;
  }

  Record& record_;
  std::vector<WorkItem> all_;
};

std::string_view ToString(Processed::State state) {
  switch (state) {
    case Processed::State::kMeasured:
      return "measured";
    case Processed::State::kSurfaceOnly:
      return "surface";
    case Processed::State::kUpToDate:
      return "up-to-date";
    case Processed::State::kWaiting:
      return "waiting";
    case Processed::State::kFailed:
      break;
  }
  return "failed";
}

}  // namespace

Result<std::vector<Processed>> ProcessCaptures(Record& record, std::optional<SessionId> session,
                                               const Progress& progress) {
  auto wanted = record.Work(session);
  if (!wanted) return Fail(wanted.error());
  auto all = record.Work();
  if (!all) return Fail(all.error());
  std::stable_partition(wanted->begin(), wanted->end(),
                        [](const WorkItem& item) { return item.capture.role.kind == CaptureRole::Kind::kNeutral; });
  Run run(record, *std::move(all));
  std::vector<Processed> done;
  for (const WorkItem& item : *wanted) {
    progress(done.size(), wanted->size(), item.capture);
    auto processed = run.Process(item);
    if (!processed) return Fail(processed.error(), "processing " + item.capture.file_name);
    done.push_back(*std::move(processed));
  }
  return done;
}

std::string Describe(const Processed& processed) {
  return fmt::format("{:<10} {:<12} {} {}: {}", ToString(processed.state), processed.capture.role.ToString(),
                     processed.capture.file_name, processed.capture.id.ToString().substr(0, 8), processed.text);
}

nlohmann::json ToJson(const Processed& processed) {
  nlohmann::json json = {{"capture", processed.capture.id.ToString()}, {"file", processed.capture.file_name},
                         {"role", processed.capture.role.ToString()},  {"analysis", processed.analysis},
                         {"state", ToString(processed.state)},         {"text", processed.text}};
  if (!processed.warning.empty()) json["warning"] = processed.warning;
  return json;
}

}  // namespace striae::app
