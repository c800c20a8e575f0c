// Photographs: the rules for adding one, and where they are.
#include "store/detail/codec.h"
#include "store/detail/keep.h"
#include "store/detail/read.h"
#include "store/detail/words.h"

namespace striae::store {
namespace {

using Kind = CaptureRole::Kind;

/// Consent holds from the day on which it was given; a session of a day before has none, whatever was signed since.
/// Sessions of the first format do not know their day.
void RefuseBeforeConsent(Database& database, const Session& session, const Subject& subject) {
  if (!session.day) return;
  const auto kind = database.One(
      "SELECT kind FROM consent WHERE subject_id = ? AND date <= ? ORDER BY number DESC LIMIT 1",
      [](const RowView& row) { return row.Text(0); }, subject.id, *session.day);
  if (kind == "given") return;
  Refuse(ErrorCode::kRecordRefused, "subject " + subject.pseudonym + " had no consent on " + session.day->ToString() +
                                        ", the day of session " + session.id.ToString() + " (given " +
                                        subject.consent_given->ToString() +
                                        "); no photograph of that day is taken or imported");
}

void RefuseUnlessAllowed(Database& database, const SessionId& id) {
  const Session session = detail::GetSession(database, id);
  const Subject subject = detail::GetSubject(database, session.subject);
  if (subject.consent_withdrawn) {
    Refuse(ErrorCode::kRecordRefused, "subject " + subject.pseudonym + " withdrew consent on " +
                                          subject.consent_withdrawn->ToString() +
                                          "; no photograph is taken or imported any more");
  }
  if (!subject.consent_given) {
    Refuse(ErrorCode::kRecordRefused, "subject " + subject.pseudonym +
                                          " has no consent in the record; enter it with 'striae consent " +
                                          subject.pseudonym + " --given DATE', or do not photograph");
  }
  RefuseBeforeConsent(database, session, subject);
  if (database.Count("SELECT count(*) FROM locked_session WHERE id = ?", id) != 0) {
    Refuse(ErrorCode::kRecordRefused,
           "session " + id.ToString() + " is locked: nothing is added; 'striae lock list' names the lock");
  }
  if (session.closed_at) {
    Refuse(ErrorCode::kRecordRefused, "session " + id.ToString() + " was closed at " + session.closed_at->ToString() +
                                          "; open a new one with 'striae session open'");
  }
}

std::string PlaceOf(Database& database, const Capture& capture) {
  const Session session = detail::GetSession(database, capture.session);
  return "subject " + detail::GetSubject(database, session.subject).pseudonym + ", visit " +
         detail::GetVisit(database, session.visit).name + ", session " + session.id.ToString() + " (as " +
         capture.file_name + ", capture " + capture.id.ToString() + ")";
}

/// The same photograph in the same session, if it is there. Refuses one that belongs elsewhere.
std::optional<Capture> FindOrRefuseElsewhere(Database& database, const Capture& wanted) {
  const auto places = database.Rows(std::string(detail::kCaptures) + " WHERE sha256 = ? ORDER BY imported_at, id",
                                    detail::ReadCapture, wanted.sha256);
  const Session session = detail::GetSession(database, wanted.session);
  for (const Capture& there : places) {
    if (there.session == wanted.session) return there;
  }
  for (const Capture& there : places) {
    const bool same_subject = detail::GetSession(database, there.session).subject == session.subject;
    // One neutral pose may serve the poses of several sessions; any other photograph was taken in one session only.
    if (same_subject && there.role.kind == Kind::kNeutral && wanted.role.kind == Kind::kNeutral) continue;
    Refuse(ErrorCode::kRecordRefused, "this photograph (" + wanted.file_name + ", SHA-256 " +
                                          wanted.sha256.ToString().substr(0, 12) + "...) is in the study already: " +
                                          PlaceOf(database, there) + "; check which one is right, nothing was added");
  }
  return std::nullopt;
}

void InsertCapture(Change& change, Database& database, const Capture& c) {
  change.Insert("capture", {{"id", ToValue(c.id)},
                            {"session_id", ToValue(c.session)},
                            {"number", detail::NextNumber(database, "capture", "session_id", c.session.ToString())},
                            {"sha256", ToValue(c.sha256)},
                            {"file_name", ToValue(c.file_name)},
                            {"media_type", ToValue(c.media_type)},
                            {"size_bytes", ToValue(c.size_bytes)},
                            {"role", ToValue(c.role.ToString())},
                            {"body_site", ToValue(c.body_site)},
                            {"laterality", ToValue(ToString(c.laterality))},
                            {"imported_at", ToValue(c.imported_at)},
                            {"metadata", ToValue(detail::Dump(detail::MetadataToJson(c.metadata)))},
                            {"preflight", ToValue(detail::Dump(detail::PreflightToJson(c.preflight)))}});
}

/// Imported again: a role that was missing is set, another role is refused.
Capture AgreeOnRole(Change& change, Capture there, const CaptureRole& role) {
  if (role.kind == Kind::kUnassigned || role == there.role) return there;
  if (there.role.kind != Kind::kUnassigned) {
    Refuse(ErrorCode::kRecordRefused, there.file_name + " is in this session already as " + there.role.ToString() +
                                          ", not as " + role.ToString() + "; nothing was changed");
  }
  change.Set("capture", there.id.ToString(), "role", ToValue(role.ToString()), "role given by a second import");
  there.role = role;
  return there;
}

}  // namespace

Status Record::MayCapture(const SessionId& session) {
  return Guarded([&] { RefuseUnlessAllowed(impl_->database, session); });
}

Result<Record::Added> Record::AddCapture(const Capture& capture, std::span<const std::uint8_t> bytes,
                                         const Stamp& stamp) {
  return Guarded([&] {
    if (bytes.empty()) Refuse(ErrorCode::kBadImage, capture.file_name + " is empty; copy it from the card again");
    Capture added = capture;
    added.sha256 = HashOf(bytes);
    added.size_bytes = bytes.size();
    added.imported_at = stamp.now;
    Database& database = impl_->database;
    // Asked before the file is kept, so that a refusal leaves no object behind, and again under the write lock.
    RefuseUnlessAllowed(database, capture.session);
    FindOrRefuseElsewhere(database, added);
    // Also for a photograph already there: a lost object comes back so.
    detail::Unwrap(impl_->objects.Put(bytes, added.sha256));
    Change change(database, stamp);
    RefuseUnlessAllowed(database, capture.session);
    if (auto there = FindOrRefuseElsewhere(database, added)) {
      Added again{AgreeOnRole(change, *std::move(there), capture.role), true};
      change.Commit();
      return again;
    }
    detail::InsertObject(change, database, added.sha256, added.size_bytes, stamp);
    InsertCapture(change, database, added);
    change.Commit();
    return Added{detail::GetCapture(database, added.id), false};
  });
}

Status Record::SetRole(const CaptureId& id, const CaptureRole& role, const std::string& reason, const Stamp& stamp) {
  return Guarded([&] {
    Change change(impl_->database, stamp);
    const Capture capture = detail::GetCapture(impl_->database, id);
    if (capture.role.kind != Kind::kUnassigned && reason.empty()) {
      Refuse(ErrorCode::kUsage, "capture is " + capture.role.ToString() + " already; a change needs a reason");
    }
    change.Set("capture", id.ToString(), "role", ToValue(role.ToString()), reason);
    change.Commit();
  });
}

Result<Capture> Record::CaptureById(const CaptureId& id) {
  return Guarded([&] { return detail::GetCapture(impl_->database, id); });
}

Result<std::vector<Capture>> Record::Captures(const SessionId& session) {
  return Guarded([&] {
    detail::GetSession(impl_->database, session);
    return impl_->database.Rows(std::string(detail::kCaptures) + " WHERE session_id = ? ORDER BY number",
                                detail::ReadCapture, session);
  });
}

Result<std::vector<Capture>> Record::CapturesOf(const Sha256& sha256) {
  return Guarded([&] {
    return impl_->database.Rows(std::string(detail::kCaptures) + " WHERE sha256 = ? ORDER BY imported_at, id",
                                detail::ReadCapture, sha256);
  });
}

}  // namespace striae::store
