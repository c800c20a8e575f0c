// Sessions: one subject before the camera, at one visit.
#include "store/detail/codec.h"
#include "store/detail/read.h"
#include "store/detail/require.h"
#include "store/detail/strike.h"
#include "store/detail/words.h"

namespace striae::store {

Result<Session> Record::OpenSession(Session session, std::string_view visit_name, const VisitId& new_visit,
                                    const Stamp& stamp, const std::string& deviation) {
  return Guarded([&] {
    if (visit_name.empty() || visit_name.size() > 64) {
      Refuse(ErrorCode::kUsage, "a session needs a visit of 1 to 64 characters, such as V1");
    }
    Database& database = impl_->database;
    Change change(database, stamp);
    detail::GetSubject(database, session.subject);
    const auto visit = database.One(std::string(detail::kVisits) + " WHERE subject_id = ? AND name = ?",
                                    detail::ReadVisit, session.subject, visit_name);
    session.visit = visit ? visit->id : new_visit;
    if (!visit) {
      change.Insert(
          "visit",
          {{"id", ToValue(new_visit)}, {"subject_id", ToValue(session.subject)}, {"name", ToValue(visit_name)}});
    }
    change.Insert("session", {{"id", ToValue(session.id)},
                              {"subject_id", ToValue(session.subject)},
                              {"visit_id", ToValue(session.visit)},
                              {"operator", ToValue(session.operator_name)},
                              {"opened_at", ToValue(session.opened_at)},
                              {"closed_at", ToValue(session.closed_at)},
                              {"site_time_zone", ToValue(session.site_time_zone)},
                              {"camera_clock_offset_s", ToValue(session.camera_clock_offset_s)},
                              {"day", ToValue(session.day)}});
    if (!deviation.empty()) {
      const std::string id = session.id.ToString();
      const NoteId note(detail::UuidFrom({"deviation", id}));
      const Date day = session.day ? *session.day : Date::Of(session.opened_at);
      detail::InsertNote(change, {note, {"session", id}, true, day, deviation, {}, {}, {}}, false, "", stamp);
    }
    change.Commit();
    return session;
  });
}

Status Record::CloseSession(const SessionId& id, const Stamp& stamp) {
  return Guarded([&] {
    Change change(impl_->database, stamp);
    const Session session = detail::GetSession(impl_->database, id);
    if (session.closed_at) {
      Refuse(ErrorCode::kRecordRefused, "this session was closed at " + session.closed_at->ToString() + " already");
    }
    change.Set("session", id.ToString(), "closed_at", ToValue(stamp.now), "");
    change.Commit();
  });
}

Status Record::ReopenSession(const SessionId& id, const std::string& reason, const Stamp& stamp) {
  return Guarded([&] {
    detail::RequireReason(reason, "opening a closed session again");
    Change change(impl_->database, stamp);
    if (!detail::GetSession(impl_->database, id).closed_at) {
      Refuse(ErrorCode::kRecordRefused, "this session is open");
    }
    change.Set("session", id.ToString(), "closed_at", detail::Value{}, reason);
    change.Commit();
  });
}

Result<Session> Record::SessionById(const SessionId& id) {
  return Guarded([&] { return detail::GetSession(impl_->database, id); });
}

Result<std::vector<Session>> Record::Sessions(std::optional<SubjectId> subject) {
  return Guarded([&] {
    constexpr const char* kOrder = " ORDER BY opened_at, id";
    if (!subject) return impl_->database.Rows(std::string(detail::kSessions) + kOrder, detail::ReadSession);
    return impl_->database.Rows(std::string(detail::kSessions) + " WHERE subject_id = ?" + kOrder, detail::ReadSession,
                                *subject);
  });
}

}  // namespace striae::store
