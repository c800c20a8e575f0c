#include "app/intake.h"

#include <algorithm>
#include <system_error>

#include "acquire/ingest.h"
#include "acquire/metadata.h"
#include "acquire/preflight.h"
#include "acquire/sidecar.h"
#include "app/io/files.h"
#include "app/sidecars.h"
#include "app/study.h"

namespace striae::app {
namespace {

namespace fs = std::filesystem;

std::string_view ToString(Intake::State state) {
  switch (state) {
    case Intake::State::kAdded:
      return "added";
    case Intake::State::kAlreadyThere:
      return "already-there";
    case Intake::State::kQuarantined:
      return "quarantined";
    case Intake::State::kRefused:
      return "refused";
    case Intake::State::kUnreadable:
      return "unreadable";
  }
  return "unreadable";
}

/// The range of the device with the photograph's serial; for a body with both, or one that the record does not know,
/// what the photograph is for decides: heads are photographed at 2 m.
RigRange RangeFor(store::Record& record, const acquire::IngestItem& item) {
  const auto kind = item.binding ? item.binding->role.kind : CaptureRole::Kind::kUnassigned;
  const bool head = kind == CaptureRole::Kind::kNeutral || kind == CaptureRole::Kind::kPose;
  const auto metadata = acquire::ReadMetadata(item.bytes);
  const auto device = metadata && !metadata->body_serial.empty()
                          ? record.DeviceBySerial(metadata->body_serial)
                          : Result<Device>(Fail(ErrorCode::kNotFound, "no serial"));
  if (device) return device->range;
  return head ? RigRange::kLarge : RigRange::kSmall;
}

/// A name that is safe in a folder: what a card calls its files may be anything.
std::string SafeName(const std::string& name) {
  std::string safe;
  for (const char c : name) {
    const bool plain =
        (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '.' || c == '-' || c == '_';
    safe += plain ? c : '_';
  }
  return safe.substr(0, 80);
}

/// Keeps the bytes beside a note. The name begins with the content's digest, so the same file is kept once.
Result<fs::path> Quarantine(store::Record& record, const acquire::IngestItem& item, const Error& why) {
  const fs::path folder = record.folder() / "quarantine";
  std::error_code code;
  fs::create_directories(folder, code);
  const std::string digest = HashOf(item.bytes).ToString();
  const fs::path kept = folder / (digest.substr(0, 12) + "-" + SafeName(item.file_name));
  const nlohmann::json note = {{"origin", item.origin},
                               {"file_name", item.file_name},
                               {"sha256", digest},
                               {"size_bytes", item.bytes.size()},
                               {"reason", std::string(striae::ToString(why.code))},
                               {"message", why.message},
                               {"session", item.binding ? item.binding->session.ToString() : ""},
                               {"at", NewStamp().now.ToString()}};
  if (auto written = WriteFile(kept, item.bytes); !written) return Fail(written.error(), "quarantine");
  if (auto written = WriteText(kept.string() + ".why.json", note.dump(1) + "\n"); !written) {
    return Fail(written.error(), "quarantine");
  }
  return kept;
}

Intake SetAside(store::Record& record, const acquire::IngestItem& item, Intake intake) {
  auto kept = Quarantine(record, item, *intake.error);
  intake.state = Intake::State::kQuarantined;
  if (kept) {
    intake.quarantine = *kept;
  } else {
    intake.state = Intake::State::kRefused;
    intake.error->message += "; and it could not be quarantined: " + kept.error().Describe();
  }
  return intake;
}

}  // namespace

Intake TakeIn(store::Record& record, const acquire::IngestItem& item, std::optional<RigRange> range, Refused refused) {
  Intake intake;
  intake.origin = item.origin;
  const auto capture = acquire::Ingest(item, {NewId<CaptureId>(), range ? *range : RangeFor(record, item)});
  if (!capture) {
    intake.error = capture.error();
    return SetAside(record, item, intake);
  }
  auto added = record.AddCapture(*capture, item.bytes, NewStamp());
  if (!added) {
    intake.error = added.error();
    intake.state = Intake::State::kRefused;
    return refused == Refused::kQuarantine ? SetAside(record, item, intake) : intake;
  }
  intake.state = added->already_there ? Intake::State::kAlreadyThere : Intake::State::kAdded;
  intake.capture = added->capture;
  return intake;
}

void AddSidecar(store::Record& record, const fs::path& photograph, Intake& intake) {
  if (!intake.capture) return;
  if (const auto written = WriteSidecar(record, *intake.capture, photograph); written) {
    intake.sidecar = acquire::SidecarPath(photograph);
  } else {
    intake.sidecar_error = written.error();
  }
}

Result<acquire::CaptureBinding> BindTo(store::Record& record, const SessionId& session_id) {
  const auto session = record.SessionById(session_id);
  if (!session) return Fail(session.error());
  if (auto allowed = record.MayCapture(session_id); !allowed) return Fail(allowed.error());
  acquire::CaptureBinding binding;
  binding.subject = session->subject;
  binding.session = session_id;
  return binding;
}

std::string Describe(const Intake& intake) {
  std::string text = intake.origin + ": " + std::string(ToString(intake.state));
  if (intake.error) text += ": " + intake.error->Describe();
  if (!intake.quarantine.empty()) text += "\n  kept in " + intake.quarantine.string();
  if (!intake.capture) return text;
  text += " as " + intake.capture->id.ToString() + " (" + intake.capture->role.ToString() + "), preflight " +
          std::string(striae::ToString(acquire::Verdict(intake.capture->preflight)));
  if (intake.sidecar_error) text += "\n  no sidecar: " + intake.sidecar_error->Describe();
  for (const auto& item : intake.capture->preflight) {
    // Said when it came; a second import does not say it again.
    if (item.state == PreflightItem::State::kOk || intake.state == Intake::State::kAlreadyThere) continue;
    text += "\n  " + item.name + ": " + std::string(striae::ToString(item.state)) + ", " + item.found + " (expected " +
            item.expected + "); " + item.advice;
  }
  return text;
}

nlohmann::json ToJson(const Intake& intake) {
  nlohmann::json json = {{"file", intake.origin}, {"status", std::string(ToString(intake.state))}};
  if (intake.error) {
    json["error"] = {{"code", std::string(striae::ToString(intake.error->code))},
                     {"message", intake.error->Describe()}};
  }
  if (!intake.quarantine.empty()) json["quarantine"] = intake.quarantine.string();
  if (!intake.sidecar.empty()) json["sidecar"] = intake.sidecar.string();
  if (intake.sidecar_error) json["sidecar_error"] = intake.sidecar_error->Describe();
  if (!intake.capture) return json;
  const Capture& capture = *intake.capture;
  json["capture"] = capture.id.ToString();
  json["sha256"] = capture.sha256.ToString();
  json["role"] = capture.role.ToString();
  json["media_type"] = capture.media_type;
  json["verdict"] = std::string(striae::ToString(acquire::Verdict(capture.preflight)));
  json["preflight"] = nlohmann::json::array();
  for (const auto& item : capture.preflight) {
    json["preflight"].push_back({{"name", item.name},
                                 {"state", std::string(striae::ToString(item.state))},
                                 {"found", item.found},
                                 {"expected", item.expected},
                                 {"advice", item.advice}});
  }
  return json;
}

nlohmann::json ToJson(const SessionId& session, const std::vector<Intake>& intakes) {
  nlohmann::json files = nlohmann::json::array();
  for (const auto& intake : intakes) files.push_back(ToJson(intake));
  const auto count = [&](auto&& matches) { return std::count_if(intakes.begin(), intakes.end(), matches); };
  return {{"session", session.ToString()},
          {"files", files},
          {"added", count([](const Intake& i) { return i.state == Intake::State::kAdded; })},
          {"already_there", count([](const Intake& i) { return i.state == Intake::State::kAlreadyThere; })},
          {"failed", count([](const Intake& i) { return !i.InRecord(); })}};
}

Status OutcomeOf(const std::vector<Intake>& intakes) {
  const auto failed = std::find_if(intakes.begin(), intakes.end(), [](const Intake& i) { return !i.InRecord(); });
  const auto bare =
      std::find_if(intakes.begin(), intakes.end(), [](const Intake& i) { return i.sidecar_error.has_value(); });
  if (failed == intakes.end() && bare != intakes.end()) {
    return Fail(bare->sidecar_error->code, "all photographs are in the record, but a sidecar could not be written: " +
                                               bare->sidecar_error->Describe());
  }
  if (failed == intakes.end()) return {};
  const auto count = std::count_if(intakes.begin(), intakes.end(), [](const Intake& i) { return !i.InRecord(); });
  return Fail(failed->error ? failed->error->code : ErrorCode::kBadImage,
              std::to_string(count) + " of " + std::to_string(intakes.size()) +
                  " photographs did not enter the record (see above); the originals were not touched");
}

}  // namespace striae::app
