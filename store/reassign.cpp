#include "store/reassign.h"

#include <algorithm>

#include "store/detail/codec.h"
#include "store/detail/read.h"
#include "store/detail/require.h"
#include "store/detail/words.h"

namespace striae::store {
namespace {

using Kind = CaptureRole::Kind;

/// One move in one transaction.
class Mover {
 public:
  Mover(Database& database, const std::string& reason, const SignedIn& by, const Stamp& stamp)
      : database_(database), reason_(reason), stamp_(Signed(by, stamp)), change_(database, stamp_) {}

  void MoveCapture(const CaptureId& id, const Session& to) {
    const Capture capture = detail::GetCapture(database_, id);
    const Session from = detail::GetSession(database_, capture.session);
    const std::string key = id.ToString();
    if (from.id == to.id) Refuse(ErrorCode::kRecordRefused, "capture " + key + " is in that session already");
    if (database_.Count("SELECT count(*) FROM capture WHERE session_id = ? AND sha256 = ?", to.id, capture.sha256)) {
      Refuse(ErrorCode::kRecordRefused, "the session has the photograph of capture " + key +
                                            " already; exclude the wrong one instead ('striae exclude')");
    }
    const std::string move = Write({"capture", key}, from, to, from.id.ToString(), to.id.ToString());
    // A number that is free in both sessions, so that neither step collides.
    const auto number = std::max(detail::NextNumber(database_, "capture", "session_id", from.id.ToString()),
                                 detail::NextNumber(database_, "capture", "session_id", to.id.ToString()));
    change_.Set("capture", key, "number", ToValue(number), reason_);
    change_.Set("capture", key, "session_id", ToValue(to.id), reason_);
    MarkStale(key, move);
    if (capture.role.kind == Kind::kNeutral) MarkPoses({from.id.ToString(), to.id.ToString()}, move);
  }

  void MoveSession(const Session& from, const SubjectId& subject, const VisitId& visit) {
    Session to = from;
    to.subject = subject;
    to.visit = visit;
    const std::string key = from.id.ToString();
    const std::string move = Write({"session", key}, from, to, from.subject.ToString(), subject.ToString());
    change_.Set("session", key, "subject_id", ToValue(subject), reason_);
    change_.Set("session", key, "visit_id", ToValue(visit), reason_);
    for (const std::string& capture : CapturesOf(key)) MarkStale(capture, move);
  }

  VisitId VisitOf(const SubjectId& subject, std::string_view name, const VisitId& new_visit) {
    const auto visit = database_.One(std::string(detail::kVisits) + " WHERE subject_id = ? AND name = ?",
                                     detail::ReadVisit, subject, name);
    if (visit) return visit->id;
    change_.Insert("visit", {{"id", ToValue(new_visit)}, {"subject_id", ToValue(subject)}, {"name", ToValue(name)}},
                   reason_);
    return new_visit;
  }

  /// Every photograph is under one subject only when all is moved.
  void CommitUnlessShared() {
    const auto shared = database_.One(
        "SELECT c.file_name, c.id, s.pseudonym FROM capture c JOIN session e ON e.id = c.session_id JOIN subject s ON "
        "s.id = e.subject_id WHERE EXISTS (SELECT 1 FROM capture o JOIN session f ON f.id = o.session_id WHERE "
        "o.sha256 = c.sha256 AND f.subject_id <> e.subject_id) AND s.id <> ?",
        [](const RowView& row) { return row.Text(0) + " (capture " + row.Text(1) + ", subject " + row.Text(2) + ")"; },
        target_);
    if (shared) {
      Refuse(ErrorCode::kRecordRefused, "the same photograph would be under two subjects: it is also " + *shared +
                                            "; move both captures in one command, nothing was moved");
    }
    change_.Commit();
  }

  void RefuseWithoutConsent(const SubjectId& id) {
    target_ = id.ToString();
    const Subject subject = detail::GetSubject(database_, id);
    if (!subject.HasActiveConsent()) {
      Refuse(ErrorCode::kRecordRefused, "subject " + subject.pseudonym +
                                            " has no active consent, so no photograph is moved there; enter it with "
                                            "'striae consent', or exclude the photograph");
    }
  }

 private:
  static Stamp Signed(const SignedIn& by, const Stamp& stamp) {
    Stamp signed_stamp = stamp;
    signed_stamp.user = by.user().name;
    return signed_stamp;
  }

  std::string Write(const Record::Found& moved, const Session& from, const Session& to, const std::string& from_id,
                    const std::string& to_id) {
    const auto earlier = database_.Count("SELECT count(*) FROM reassignment WHERE entity_id = ?", moved.id);
    std::string id =
        detail::UuidFrom({"reassignment", moved.id, from_id, to_id, std::to_string(earlier), stamp_.now.ToString()})
            .ToString();
    change_.Insert("reassignment",
                   {{"id", ToValue(id)},
                    {"entity", ToValue(moved.entity)},
                    {"entity_id", ToValue(moved.id)},
                    {"from_id", ToValue(from_id)},
                    {"to_id", ToValue(to_id)},
                    {"from_subject", ToValue(from.subject)},
                    {"to_subject", ToValue(to.subject)},
                    {"from_visit", ToValue(from.visit)},
                    {"to_visit", ToValue(to.visit)},
                    {"reason", ToValue(reason_)},
                    {"by", ToValue(stamp_.user)},
                    {"at", ToValue(stamp_.now)}},
                   reason_);
    return id;
  }

  void MarkStale(const std::string& capture, const std::string& move) {
    const auto last = database_.Count("SELECT coalesce(max(number), 0) FROM outcome WHERE capture_id = ?", capture);
    if (last == 0) return;
    const std::string id = detail::UuidFrom({"stale", capture, move}).ToString();
    if (database_.Count("SELECT count(*) FROM stale_mark WHERE id = ?", id) != 0) return;
    change_.Insert("stale_mark",
                   {{"id", ToValue(id)},
                    {"capture_id", ToValue(capture)},
                    {"outcomes", ToValue(last)},
                    {"reassignment_id", ToValue(move)}},
                   reason_);
  }

  /// The poses of a session are measured against its neutral pose.
  void MarkPoses(const std::vector<std::string>& sessions, const std::string& move) {
    for (const std::string& session : sessions) {
      for (const std::string& pose : database_.Rows(
               "SELECT id FROM capture WHERE session_id = ? AND role = 'pose' ORDER BY id",
               [](const RowView& row) { return row.Text(0); }, session)) {
        MarkStale(pose, move);
      }
    }
  }

  std::vector<std::string> CapturesOf(const std::string& session) {
    return database_.Rows(
        "SELECT id FROM capture WHERE session_id = ? ORDER BY number", [](const RowView& row) { return row.Text(0); },
        session);
  }

  Database& database_;
  const std::string& reason_;
  Stamp stamp_;
  Change change_;
  std::string target_;
};

}  // namespace

Status ReassignCaptures(Record& record, std::span<const CaptureId> captures, const SessionId& to,
                        const std::string& reason, const SignedIn& by, const Stamp& stamp) {
  return Guarded([&] {
    detail::Unwrap(RequireRight(by, Act::kReassign));
    detail::RequireReason(reason, "a reassignment");
    if (captures.empty()) Refuse(ErrorCode::kUsage, "name the captures that move");
    Database& database = Access::Of(record).database;
    Mover mover(database, reason, by, stamp);
    const Session session = detail::GetSession(database, to);
    mover.RefuseWithoutConsent(session.subject);
    for (const CaptureId& capture : captures) mover.MoveCapture(capture, session);
    mover.CommitUnlessShared();
  });
}

Status ReassignSession(Record& record, const SessionId& session, const SubjectId& to, std::string_view visit_name,
                       const VisitId& new_visit, const std::string& reason, const SignedIn& by, const Stamp& stamp) {
  return Guarded([&] {
    detail::Unwrap(RequireRight(by, Act::kReassign));
    detail::RequireReason(reason, "a reassignment");
    Database& database = Access::Of(record).database;
    Mover mover(database, reason, by, stamp);
    const Session from = detail::GetSession(database, session);
    mover.RefuseWithoutConsent(to);
    if (from.subject == to && detail::GetVisit(database, from.visit).name == visit_name) {
      Refuse(ErrorCode::kRecordRefused, "the session belongs to that subject and visit already");
    }
    mover.MoveSession(from, to, mover.VisitOf(to, visit_name, new_visit));
    mover.CommitUnlessShared();
  });
}

Result<std::vector<Reassignment>> Reassignments(Record& record, std::optional<std::string> moved) {
  return Guarded([&] {
    return Access::Of(record).database.Rows(
        "SELECT entity, entity_id, from_id, to_id, from_subject, to_subject, reason, by, at FROM reassignment WHERE ?1 "
        "IS NULL OR entity_id = ?1 ORDER BY at, id",
        [](const RowView& row) {
          return Reassignment{{row.Text(0), row.Text(1)}, row.Text(2), row.Text(3), row.Key<SubjectId>(4),
                              row.Key<SubjectId>(5),      row.Text(6), row.Text(7), row.Time(8)};
        },
        moved);
  });
}

Result<std::vector<CaptureId>> StaleCaptures(Record& record) {
  return Guarded([&] {
    return Access::Of(record).database.Rows(
        "SELECT DISTINCT o.capture_id FROM stale_mark k JOIN outcome o ON o.capture_id = k.capture_id AND o.number <= "
        "k.outcomes WHERE NOT EXISTS (SELECT 1 FROM outcome newer WHERE newer.supersedes = o.id) ORDER BY 1",
        [](const RowView& row) { return row.Key<CaptureId>(0); });
  });
}

}  // namespace striae::store
