#include "app/session_label.h"

#include <algorithm>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/io/photograph.h"
#include "app/kept_surface.h"
#include "app/local_time.h"
#include "app/names.h"
#include "app/study.h"
#include "core/calibration.h"
#include "core/target.h"
#include "reconstruct/target.h"
#include "store/annotations.h"

namespace striae::app {
namespace {

using store::Record;
using store::WorkItem;

/// What the photograph shows: {"marker": 177} or {"marker": null}.
struct Seen {
  std::optional<int> marker_id;
  Sha256 file;
};

/// Of the device, else one of the D90's with 50 mm: here it only says which lines are straight.
Result<CameraModel> CameraOf(Record& record, const WorkItem& item, const Photograph& photograph) {
  const int width = photograph.luminance.width(), height = photograph.luminance.height();
  if (item.calibration) {
    const auto bytes = record.objects().Get(item.calibration->sha256);
    if (!bytes) return Fail(bytes.error());
    const auto calibration = CalibrationFromJson({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    if (calibration && calibration->image_width_px == width) return calibration->camera;
  }
  constexpr double kFocalOverWidth = 50.0 / 23.6;
  CameraModel camera;
  camera.fx = camera.fy = kFocalOverWidth * width;
  camera.cx = (width - 1) / 2.0;
  camera.cy = (height - 1) / 2.0;
  return camera;
}

Result<std::optional<int>> LookFor(Record& record, const WorkItem& item) {
  const auto bytes = record.objects().Get(item.capture.sha256);
  if (!bytes) return Fail(bytes.error());
  auto photograph = DecodePhotograph(*bytes);
  if (!photograph) return std::optional<int>();
  const auto camera = CameraOf(record, item, *photograph);
  if (!camera) return Fail(camera.error());
  auto phase = reconstruct::MeasurePhase(*photograph);
  if (!phase) {
    // Without stripes there is nothing to take away.
    phase = reconstruct::PhaseResult{};
    phase->background = std::move(photograph->luminance);
    phase->carrier_period_px = 1;
  }
  constexpr double kAnySide = 40;  // mm: what the label measures does not matter to which one it is
  const auto target = reconstruct::FindTarget(*phase, *camera, kAnySide);
  return target ? std::optional(target->marker_id) : std::nullopt;
}

Result<Seen> SeenIn(Record& record, const WorkItem& item) {
  const std::vector<ProvenanceInput> sources = {{"photograph", item.capture.sha256}};
  const auto known = record.LatestDerived(item.capture.id, kLabelKind);
  if (!known) return Fail(known.error());
  if (*known && SameSources((*known)->provenance, sources)) {
    const auto bytes = record.ReadDerived(**known);
    if (!bytes) return Fail(bytes.error());
    const auto json = nlohmann::json::parse(*bytes, nullptr, false);
    Seen seen{{}, (*known)->sha256};
    if (json.is_object() && json.contains("marker") && json["marker"].is_number_integer())
      seen.marker_id = json["marker"];
    return seen;
  }
  const auto found = LookFor(record, item);
  if (!found) return Fail(found.error());
  nlohmann::json json = {{"dictionary", kLabelDictionary}, {"marker", nullptr}};
  if (*found) json["marker"] = **found;
  const std::string text = json.dump();
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  store::Derived derived;
  derived.capture = item.capture.id;
  derived.kind = kLabelKind;
  derived.media_type = "application/json";
  derived.provenance = NewProvenance(sources);
  const auto kept = record.AddDerived(derived, bytes, NewStamp());
  // Of a locked session nothing is kept; what is seen can be said all the same.
  if (!kept && kept.error().code != ErrorCode::kRecordRefused) return Fail(kept.error());
  return Seen{*found, store::HashOf(bytes)};
}

/// "3F2A-91BC (S002, V1)".
Result<std::string> CodeOf(Record& record, const Session& session) {
  const auto place = PlaceOf(record, session);
  if (!place) return Fail(place.error());
  return SessionCode(session.id) + " (" + *place + ")";
}

}  // namespace

Result<std::optional<ForeignLabel>> ForeignLabelIn(Record& record, const WorkItem& item) {
  const auto seen = SeenIn(record, item);
  if (!seen) return Fail(seen.error());
  if (!seen->marker_id || *seen->marker_id == LabelMarkerId(item.session.id)) return std::optional<ForeignLabel>();
  const auto sessions = record.Sessions();
  if (!sessions) return Fail(sessions.error());
  std::string others;
  for (const Session& session : *sessions) {
    if (LabelMarkerId(session.id) != *seen->marker_id) continue;
    const auto name = CodeOf(record, session);
    if (!name) return Fail(name.error());
    others += (others.empty() ? "" : " or ") + *name;
  }
  const auto own = CodeOf(record, item.session);
  if (!own) return Fail(own.error());
  const std::string whose = others.empty()
                                ? "of no session of this study (marker " + std::to_string(*seen->marker_id) + ")"
                                : "of session " + others;
  return std::optional(ForeignLabel{
      *seen->marker_id, seen->file,
      "the label in the photograph is " + whose + ", the photograph was logged in session " + *own +
          ": wrong patient or wrong label? move it with 'striae reassign', or exclude it with 'striae exclude'"});
}

Status NoteDeviation(Record& record, const WorkItem& item, const ForeignLabel& label) {
  const auto notes = store::Notes(record, item.capture.id.ToString());
  if (!notes) return Fail(notes.error());
  const bool noted = std::any_of(notes->begin(), notes->end(), [&](const store::StudyNote& note) {
    return note.deviation && note.text == label.reason;
  });
  if (noted) return {};
  const store::Stamp stamp = NewStamp();
  store::StudyNote note;
  note.id = NewId<store::NoteId>();
  note.about = {"capture", item.capture.id.ToString()};
  note.deviation = true;
  note.date = DayAt(stamp.now, stamp.zone);
  note.text = label.reason;
  return store::AddNote(record, note, "", stamp);
}

}  // namespace striae::app
