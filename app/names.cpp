#include "app/names.h"

#include "core/target.h"

namespace striae::app {

Result<Session> FindSession(store::Record& record, const std::string& text) {
  if (const auto id = SessionId::Parse(text)) return record.SessionById(*id);
  constexpr std::size_t kShortest = 8;
  std::string begin = DigitsOfSessionCode(text);
  if (begin.empty() && text.size() >= kShortest) begin = text;
  const auto sessions = record.Sessions();
  if (!sessions) return Fail(sessions.error());
  const Session* found = nullptr;
  for (const Session& session : *sessions) {
    if (begin.empty() || !session.id.ToString().starts_with(begin)) continue;
    if (found != nullptr) {
      return Fail(ErrorCode::kUsage, "two sessions are called " + text.substr(0, 40) + "; give the whole id");
    }
    found = &session;
  }
  if (found != nullptr) return *found;
  return Fail(ErrorCode::kNotFound,
              "no session '" + text.substr(0, 40) +
                  "' in this study; give its id ('striae session list') or the code on its label (3F2A-91BC)");
}

Result<std::string> PlaceOf(store::Record& record, const Session& session) {
  const auto subject = record.SubjectById(session.subject);
  if (!subject) return Fail(subject.error());
  const auto visit = record.VisitById(session.visit);
  if (!visit) return Fail(visit.error());
  return subject->pseudonym + ", " + visit->name;
}

Result<std::string> NameOf(store::Record& record, const store::Record::Found& found) {
  if (found.entity == "subject") {
    const auto id = SubjectId::Parse(found.id);
    const auto subject = id ? record.SubjectById(*id) : Result<Subject>(Fail(id.error()));
    if (!subject) return Fail(subject.error());
    return "subject " + subject->pseudonym;
  }
  if (found.entity != "session") return found.entity + " " + found.id;
  const auto id = SessionId::Parse(found.id);
  const auto session = id ? record.SessionById(*id) : Result<Session>(Fail(id.error()));
  if (!session) return Fail(session.error());
  const auto place = PlaceOf(record, *session);
  if (!place) return Fail(place.error());
  return "session " + found.id + " (" + *place + ")";
}

}  // namespace striae::app
