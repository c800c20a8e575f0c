#include "app/dicom_session.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "app/io/files.h"
#include "app/staging.h"
#include "core/ply.h"
#include "dicom/measurement_report.h"
#include "dicom/photo.h"
#include "dicom/surface_model.h"
#include "dicom/thin.h"

namespace striae::app {
namespace {

using dicom::ObjectReference;
using dicom::SessionContext;
using store::Derived;
using store::Outcome;
using store::Record;
using store::WorkItem;

constexpr const char* kPhotographInput = "photograph";
constexpr const char* kNeutralInput = "neutral photograph";
constexpr const char* kSurfaceInput = "surface";

std::optional<Sha256> InputOf(const AnalysisReport& report, std::string_view name) {
  for (const ProvenanceInput& input : report.provenance.inputs) {
    if (input.name == name) return input.sha256;
  }
  return std::nullopt;
}

/// The registered apparatus; else what the photograph says of itself.
Device DeviceOf(Record& record, const Capture& capture) {
  if (auto device = record.DeviceBySerial(capture.metadata.body_serial)) return *std::move(device);
  Device device;
  device.serial = capture.metadata.body_serial;
  device.model = capture.metadata.model;
  return device;
}

Result<SessionContext> ContextOf(Record& record, const SessionId& id, bool strip_jpeg_metadata) {
  SessionContext context;
  context.strip_jpeg_metadata = strip_jpeg_metadata;
  auto session = record.SessionById(id);
  if (!session) return Fail(session.error());
  context.session = *std::move(session);
  auto subject = record.SubjectById(context.session.subject);
  if (!subject) return Fail(subject.error());
  context.subject = *std::move(subject);
  auto visit = record.VisitById(context.session.visit);
  if (!visit) return Fail(visit.error());
  context.visit = *std::move(visit);
  auto study = record.GetStudy();
  if (!study) return Fail(study.error());
  context.study = *std::move(study);
  const auto sites = record.Sites();
  if (!sites) return Fail(sites.error());
  for (const Site& site : *sites) {
    if (site.id == context.subject.site) context.site = site;
  }
  return context;
}

/// Encodes the objects of one session one after another, and hands each to `write` with its file name.
class Exporter {
 public:
  Exporter(Record& record, SessionContext context, std::filesystem::path folder)
      : record_(record), context_(std::move(context)), folder_(std::move(folder)) {}

  Result<SessionExport> Export() {
    const auto captures = record_.Captures(context_.session.id);
    if (!captures) return Fail(captures.error());
    const auto work = record_.Work(context_.session.id);
    if (!work) return Fail(work.error());
    for (std::size_t i = 0; i < captures->size(); ++i) {
      if (auto done = ExportPhoto((*captures)[i], static_cast<int>(i) + 1); !done) return Fail(done.error());
    }
    for (const WorkItem& item : *work) {
      if (!photos_.contains(item.capture.id)) continue;
      if (auto done = ExportSurface(item); !done) return Fail(done.error());
    }
    if (auto done = ExportReport(*work); !done) return Fail(done.error());
    if (export_.objects.empty()) {
      return Fail(ErrorCode::kNotFound, "the session has no JPEG photograph that can become a DICOM object");
    }
    return std::move(export_);
  }

 private:
  SessionContext ContextFor(const Capture& capture) {
    SessionContext context = context_;
    context.device = DeviceOf(record_, capture);
    return context;
  }

  Status Write(const dicom::Object& object, const std::string& entity_id, std::optional<CaptureId> capture) {
    const std::string name = std::string(ToString(object.reference.kind)) + "-" + entity_id.substr(0, 8) + ".dcm";
    if (auto written = WriteFile(folder_ / name, object.bytes); !written) return written;
    export_.objects.push_back({name, object.reference, capture});
    return {};
  }

  void LeaveOut(const Capture& capture, const std::string& reason) {
    export_.left_out.push_back({capture.id, capture.file_name, reason});
  }

  Result<dicom::Object> EncodePhoto(const SessionContext& context, const Capture& capture, int number) {
    const auto bytes = record_.objects().Get(capture.sha256);
    if (!bytes) return Fail(bytes.error());
    return dicom::EncodePhoto(context, capture, *bytes, number);
  }

  Status ExportPhoto(const Capture& capture, int number) {
    if (capture.media_type != "image/jpeg") {
      LeaveOut(capture, "only a JPEG goes into DICOM; this is " + capture.media_type);
      return {};
    }
    const auto photo = EncodePhoto(ContextFor(capture), capture, number);
    if (!photo && photo.error().code == ErrorCode::kBadImage) {
      LeaveOut(capture, photo.error().Describe());
      return {};
    }
    if (!photo) return Fail(photo.error());
    photos_[capture.id] = photo->reference;
    return Write(*photo, capture.id.ToString(), capture.id);
  }

  /// The surface that the numbers in force came from; without numbers the newest one.
  Result<std::optional<Derived>> SurfaceOf(const WorkItem& item) {
    for (const Outcome& outcome : item.outcomes) {
      const auto wanted = outcome.failure ? std::nullopt : InputOf(outcome.report, kSurfaceInput);
      if (!wanted) continue;
      const auto derived = record_.DerivedOf(item.capture.id);
      if (!derived) return Fail(derived.error());
      const auto found = std::find_if(derived->begin(), derived->end(), [&](const Derived& candidate) {
        return candidate.kind == kSurfaceInput && candidate.sha256 == *wanted;
      });
      if (found != derived->end()) return std::optional(*found);
    }
    return record_.LatestDerived(item.capture.id, kSurfaceInput);
  }

  Status ExportSurface(const WorkItem& item) {
    const auto derived = SurfaceOf(item);
    if (!derived) return Fail(derived.error());
    if (!*derived) {
      LeaveOut(item.capture, "no surface yet; run: striae process --session " + context_.session.id.ToString());
      return {};
    }
    const auto bytes = record_.ReadDerived(**derived);
    if (!bytes) return Fail(bytes.error());
    const auto surface = DecodePly(*bytes);
    if (!surface) return Fail(surface.error(), "the surface kept for " + item.capture.file_name);
    const auto thinned = dicom::ThinSurface(*surface);
    if (!thinned) return Fail(thinned.error(), "the surface of " + item.capture.file_name);
    const auto model = dicom::EncodeSurface(ContextFor(item.capture), item.capture, *thinned, photos_[item.capture.id],
                                            (*derived)->provenance.version);
    if (!model) return Fail(model.error());
    surfaces_[item.capture.id] = model->reference;
    return Write(*model, item.capture.id.ToString(), item.capture.id);
  }

  /// The photograph of the neutral pose: an object of this session, or of the earlier one in which it was taken.
  Result<std::optional<ObjectReference>> Neutral(const AnalysisReport& report) {
    const auto sha256 = InputOf(report, kNeutralInput);
    if (!sha256) return std::optional<ObjectReference>();
    const auto captures = record_.CapturesOf(*sha256);
    if (!captures) return Fail(captures.error());
    for (const Capture& capture : *captures) {
      if (photos_.contains(capture.id)) return std::optional(photos_[capture.id]);
    }
    if (captures->empty()) return std::optional<ObjectReference>();
    const Capture& neutral = captures->front();
    auto context = ContextOf(record_, neutral.session, context_.strip_jpeg_metadata);
    if (!context) return Fail(context.error());
    context->device = DeviceOf(record_, neutral);
    const auto all = record_.Captures(neutral.session);
    if (!all) return Fail(all.error());
    const auto at = std::find_if(all->begin(), all->end(), [&](const Capture& c) { return c.id == neutral.id; });
    const auto photo = EncodePhoto(*context, neutral, static_cast<int>(at - all->begin()) + 1);
    if (!photo) return Fail(photo.error(), "the neutral pose " + neutral.file_name);
    return std::optional(photo->reference);
  }

  Status ExportReport(const std::vector<WorkItem>& work) {
    std::vector<dicom::MeasurementGroup> groups;
    for (const WorkItem& item : work) {
      if (!surfaces_.contains(item.capture.id)) continue;
      for (const Outcome& outcome : item.outcomes) {
        if (outcome.failure || outcome.report.measurements.empty()) continue;
        if (InputOf(outcome.report, kPhotographInput) != item.capture.sha256) {
          LeaveOut(item.capture, "its numbers are of another photograph; process it again");
          continue;
        }
        dicom::MeasurementGroup group{
            item.capture, outcome.report, outcome.at, {photos_[item.capture.id], surfaces_[item.capture.id]}};
        const auto neutral = Neutral(outcome.report);
        if (!neutral) return Fail(neutral.error());
        if (*neutral) group.evidence.push_back(**neutral);
        groups.push_back(std::move(group));
      }
    }
    if (groups.empty()) return {};
    const auto report = dicom::EncodeMeasurements(ContextFor(groups.front().capture), groups, 1);
    if (!report) return Fail(report.error());
    return Write(*report, context_.session.id.ToString(), std::nullopt);
  }

  Record& record_;
  SessionContext context_;
  std::filesystem::path folder_;
  std::map<CaptureId, ObjectReference> photos_, surfaces_;
  SessionExport export_;
};

}  // namespace

Result<SessionExport> ExportSession(store::Record& record, const SessionId& session, bool strip_jpeg_metadata,
                                    const std::filesystem::path& folder) {
  auto context = ContextOf(record, session, strip_jpeg_metadata);
  if (!context) return Fail(context.error());
  if (context->subject.consent_withdrawn) {
    return Fail(ErrorCode::kRecordRefused, context->subject.pseudonym + " withdrew consent on " +
                                               context->subject.consent_withdrawn->ToString() +
                                               "; nothing of this subject leaves the study any more");
  }
  const auto staging = Staging::In(folder);
  if (!staging) return Fail(staging.error());
  auto exported = Exporter(record, *std::move(context), (*staging)->path()).Export();
  if (!exported) return Fail(exported.error());
  std::vector<std::string> names;
  for (const ExportedObject& object : exported->objects) names.push_back(object.file_name);
  if (auto published = (*staging)->Publish(names); !published) return Fail(published.error());
  return exported;
}

nlohmann::json ToJson(const SessionExport& exported, const SessionId& session, const std::filesystem::path& folder) {
  nlohmann::json document = {{"session", session.ToString()},
                             {"folder", folder.string()},
                             {"objects", nlohmann::json::array()},
                             {"left_out", nlohmann::json::array()}};
  for (const ExportedObject& object : exported.objects) {
    nlohmann::json entry = {
        {"kind", ToString(object.reference.kind)},         {"file", object.file_name},
        {"study_uid", object.reference.study_uid},         {"series_uid", object.reference.series_uid},
        {"sop_class_uid", object.reference.sop_class_uid}, {"sop_instance_uid", object.reference.sop_instance_uid}};
    if (object.capture) entry["capture"] = object.capture->ToString();
    document["objects"].push_back(std::move(entry));
  }
  for (const LeftOut& left_out : exported.left_out) {
    document["left_out"].push_back(
        {{"capture", left_out.capture.ToString()}, {"file", left_out.file_name}, {"reason", left_out.reason}});
  }
  return document;
}

}  // namespace striae::app
