// A photograph on its way into the record, whatever it came from: judged, then kept, or set aside with the reason.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "acquire/source.h"
#include "core/study.h"
#include "store/record.h"

namespace striae::app {

struct Intake {
  enum class State {
    kAdded,
    kAlreadyThere,  ///< the session has it from before; nothing was added
    kQuarantined,   ///< not whole, or nobody's: kept in the study's quarantine folder
    kRefused,       ///< the record's rules say no; the source still has it
    kUnreadable,    ///< the source could not give it
  };
  State state = State::kUnreadable;
  std::string origin;
  std::optional<Capture> capture;  ///< when added or already there
  std::optional<Error> error;      ///< when not
  std::filesystem::path quarantine;
  std::filesystem::path sidecar;       ///< the XMP file beside it, when one was asked for
  std::optional<Error> sidecar_error;  ///< it could not be written; the photograph is in the record all the same
  [[nodiscard]] bool InRecord() const { return state == State::kAdded || state == State::kAlreadyThere; }
};

/// What to do with a photograph that the record refuses.
enum class Refused {
  kLeaveAtSource,  ///< a file: it stays where it is
  kQuarantine,     ///< a camera's: this may be the only copy at hand
};

/// Structure, metadata, preflight, record. `range` overrides the range of the device that the photograph's serial names
/// (small when there is none). A quarantined photograph lies in <study>/quarantine/ beside a note that says why.
Intake TakeIn(store::Record& record, const acquire::IngestItem& item, std::optional<RigRange> range, Refused refused);

/// Writes the XMP sidecar of a photograph that is in the record; nothing for one that is not.
void AddSidecar(store::Record& record, const std::filesystem::path& photograph, Intake& intake);

/// The binding of a session, checked before any photograph: the session is open and its subject consents.
Result<acquire::CaptureBinding> BindTo(store::Record& record, const SessionId& session);

/// One line for each photograph and one for each item of its preflight that is not ok.
std::string Describe(const Intake& intake);
nlohmann::json ToJson(const Intake& intake);

/// {"session", "files": [...], "added", "already_there", "failed"}; kBadImage when a photograph is not in the record.
nlohmann::json ToJson(const SessionId& session, const std::vector<Intake>& intakes);
Status OutcomeOf(const std::vector<Intake>& intakes);

}  // namespace striae::app
