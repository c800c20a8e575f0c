// `striae reassign`: photographs or a session that were logged under the wrong subject.
#include <algorithm>

#include "app/sign_in.h"
#include "app/study.h"
#include "store/json.h"

namespace striae::app {
namespace {

struct Options {
  std::vector<std::string> things;
  std::string to, visit, reason;
  SignInOptions sign_in;
};

/// The session of `subject` for photographs of `from`: the one at the visit of that name on that day, else a new one
/// with the old one's time.
Result<SessionId> SessionFor(store::Record& record, const Subject& subject, const Session& from,
                             const std::string& visit_name) {
  const auto sessions = record.Sessions(subject.id);
  if (!sessions) return Fail(sessions.error());
  const auto day = [](const Session& session) { return session.day.value_or(Date::Of(session.opened_at)); };
  for (const Session& session : *sessions) {
    const auto visit = record.VisitById(session.visit);
    if (!visit) return Fail(visit.error());
    if (visit->name == visit_name && day(session) == day(from)) return session.id;
  }
  Session session = from;
  session.id = NewId<SessionId>();
  session.subject = subject.id;
  const auto opened = record.OpenSession(session, visit_name, NewId<VisitId>(), NewStamp());
  if (!opened) return Fail(opened.error());
  return opened->id;
}

Result<std::string> VisitNameOf(store::Record& record, const Session& session, const Options& options) {
  if (!options.visit.empty()) return options.visit;
  const auto visit = record.VisitById(session.visit);
  if (!visit) return Fail(visit.error());
  return visit->name;
}

Status MoveSession(store::Record& record, const SessionId& id, const store::Record::Found& to, const Options& options,
                   const store::SignedIn& by) {
  if (to.entity != "subject") return Fail(ErrorCode::kUsage, "a session is moved to a subject; --to PSEUDONYM");
  const auto session = record.SessionById(id);
  if (!session) return Fail(session.error());
  const auto visit = VisitNameOf(record, *session, options);
  if (!visit) return Fail(visit.error());
  return store::ReassignSession(record, id, *SubjectId::Parse(to.id), *visit, NewId<VisitId>(), options.reason, by,
                                NewStamp());
}

Status MoveCaptures(store::Record& record, const std::vector<CaptureId>& captures, const store::Record::Found& to,
                    const Options& options, const store::SignedIn& by) {
  if (to.entity == "session") {
    return store::ReassignCaptures(record, captures, *SessionId::Parse(to.id), options.reason, by, NewStamp());
  }
  if (to.entity != "subject") return Fail(ErrorCode::kUsage, "--to is a pseudonym or the id of a session");
  const auto subject = record.SubjectById(*SubjectId::Parse(to.id));
  if (!subject) return Fail(subject.error());
  const auto capture = record.CaptureById(captures.front());
  if (!capture) return Fail(capture.error());
  const auto from = record.SessionById(capture->session);
  if (!from) return Fail(from.error());
  if (from->subject == subject->id) {
    return Fail(ErrorCode::kRecordRefused, "it belongs to " + subject->pseudonym + " already");
  }
  if (!subject->HasActiveConsent()) {
    return Fail(ErrorCode::kRecordRefused, "subject " + subject->pseudonym +
                                               " has no active consent, so no photograph "
                                               "is moved there; enter it with 'striae consent'");
  }
  const auto visit = VisitNameOf(record, *from, options);
  if (!visit) return Fail(visit.error());
  const auto session = SessionFor(record, *subject, *from, *visit);
  if (!session) return Fail(session.error(), "opening a session for the photographs");
  return store::ReassignCaptures(record, captures, *session, options.reason, by, NewStamp());
}

Status Run(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto to = record->Find(options.to);
  if (!to) return Fail(to.error(), "--to");
  std::vector<CaptureId> captures;
  std::optional<SessionId> session;
  for (const std::string& text : options.things) {
    const auto found = record->Find(text);
    if (!found) return Fail(found.error());
    if (found->entity == "session" && options.things.size() == 1) {
      session = *SessionId::Parse(found->id);
      continue;
    }
    const auto capture = FindCapture(*record, text);
    if (!capture) return Fail(capture.error());
    captures.push_back(capture->id);
  }
  const auto by = SignInFor(*record, options.sign_in, store::Act::kReassign);
  if (!by) return Fail(by.error());
  if (options.reason.empty()) return Fail(ErrorCode::kUsage, "a reassignment needs a reason; give --reason");
  const Status moved =
      session ? MoveSession(*record, *session, *to, options, *by) : MoveCaptures(*record, captures, *to, options, *by);
  if (!moved) return Fail(moved.error(), "reassigning");
  nlohmann::json document = {{"moved", nlohmann::json::array()}};
  const auto add = [&](const std::string& id) -> Status {
    const auto moves = store::Reassignments(*record, id);
    if (!moves) return Fail(moves.error());
    document["moved"].push_back(store::ToJson(moves->back()));
    return {};
  };
  if (session) {
    if (const Status added = add(session->ToString()); !added) return Fail(added.error());
  }
  for (const CaptureId& capture : captures) {
    if (const Status added = add(capture.ToString()); !added) return Fail(added.error());
  }
  run.Output(document, std::to_string(document["moved"].size()) +
                           " moved; results of it are stale until 'striae process' computes them again");
  return {};
}

}  // namespace

void AddCommand_reassign(CLI::App& root, Context& context) {
  auto options = std::make_shared<Options>();
  CLI::App* command = AddCommand(root, context, "reassign", "Move photographs or a session to the right subject",
                                 "striae -C trial reassign 3f0c4f5e --to S002 --reason \"logged under S001 by "
                                 "mistake\" --user anna");
  command->add_option("ID", options->things, "Captures, or one session")->required();
  command->add_option("--to", options->to, "The right subject, or (for captures) the right session")->required();
  command->add_option("--visit", options->visit, "The visit there (default: of the same name)");
  command->add_option("--reason", options->reason, "Why")->required();
  AddSignInOptions(*command, options->sign_in);
  OnRun(command, context, [options](Context& run) { return Run(run, *options); });
}

}  // namespace striae::app
