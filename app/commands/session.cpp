// `striae session open|list|close|reopen`: one subject before the camera, at one visit.
#include "app/listing.h"
#include "app/local_time.h"
#include "app/names.h"
#include "app/study.h"
#include "store/json.h"

namespace striae::app {
namespace {

struct Options {
  std::string subject, visit, session, date, unscheduled, reason;
  std::optional<int> clock_offset_s;
};

nlohmann::json Placed(const Session& session, const Subject& subject, const Visit& visit) {
  nlohmann::json object = store::ToJson(session);
  object["subject"] = subject.pseudonym;
  object["visit"] = visit.name;
  return object;
}

/// Sets when the session was: now, or at --date in the site's zone, which must not lie ahead.
Status SetTime(Session& session, const std::string& date, UtcTime now) {
  if (!date.empty()) {
    const auto then = ParseLocal(date, session.site_time_zone);
    if (!then) return Fail(then.error(), "--date");
    // A day without an hour is noon; today's is now.
    const bool today = DayAt(now, session.site_time_zone) == DayAt(*then, session.site_time_zone);
    session.opened_at = date.size() == 10 && today ? now : *then;
    if (session.opened_at > now) {
      return Fail(ErrorCode::kUsage, "--date " + date + " lies ahead; a session is opened when it is held");
    }
  }
  session.day = DayAt(session.opened_at, session.site_time_zone);
  return {};
}

/// What the plan says about this visit; one that it does not name needs --unscheduled.
Result<std::string> DeviationOf(store::Record& record, const Session& session, const Options& options) {
  if (!options.unscheduled.empty()) return "unscheduled visit " + options.visit + ": " + options.unscheduled;
  const auto state = store::PlanFor(record, session.subject, options.visit, *session.day);
  if (!state) return Fail(state.error(), "opening a session");
  if (!*state || (*state)->state != store::VisitState::State::kOutOfWindow) return std::string();
  return "visit " + options.visit + " on " + session.day->ToString() + " is out of its window, " +
         (*state)->earliest->ToString() + " to " + (*state)->latest->ToString();
}

Status Open(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto subject = record->SubjectByPseudonym(options.subject);
  if (!subject) return Fail(subject.error());
  const auto sites = record->Sites();
  if (!sites) return Fail(sites.error());
  const store::Stamp stamp = NewStamp();
  Session session;
  session.id = NewId<SessionId>();
  session.subject = subject->id;
  session.operator_name = stamp.user;
  session.opened_at = stamp.now;
  session.camera_clock_offset_s = options.clock_offset_s;
  for (const Site& site : *sites) {
    if (site.id == subject->site) session.site_time_zone = site.time_zone;
  }
  if (const Status set = SetTime(session, options.date, stamp.now); !set) return Fail(set.error());
  const auto deviation = DeviationOf(*record, session, options);
  if (!deviation) return Fail(deviation.error());
  const auto opened = record->OpenSession(session, options.visit, NewId<VisitId>(), stamp, *deviation);
  if (!opened) return Fail(opened.error(), "opening a session");
  if (!deviation->empty()) run.Note("deviation noted: " + *deviation);
  if (!subject->HasActiveConsent()) {
    run.Note("note: " + subject->pseudonym + " has no active consent; photographs will be refused until it is entered");
  }
  run.Output(Placed(*opened, *subject, Visit{opened->visit, subject->id, options.visit}), opened->id.ToString());
  return {};
}

Status List(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  std::optional<SubjectId> only;
  if (!options.subject.empty()) {
    const auto subject = record->SubjectByPseudonym(options.subject);
    if (!subject) return Fail(subject.error());
    only = subject->id;
  }
  const auto sessions = record->Sessions(only);
  if (!sessions) return Fail(sessions.error());
  Listing listing(run, "sessions", "no sessions yet");
  for (const Session& session : *sessions) {
    const auto subject = record->SubjectById(session.subject);
    if (!subject) return Fail(subject.error());
    const auto visit = record->VisitById(session.visit);
    if (!visit) return Fail(visit.error());
    listing.Add(listing.json() ? Placed(session, *subject, *visit).dump()
                               : session.id.ToString() + "  " + subject->pseudonym + "  " + visit->name + "  " +
                                     session.opened_at.ToString() + (session.closed_at ? "  closed" : "  open"));
  }
  return listing.Print();
}

Status Close(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto found = FindSession(*record, options.session);
  if (!found) return Fail(found.error());
  const SessionId id = found->id;
  if (const Status closed = record->CloseSession(id, NewStamp()); !closed) {
    return Fail(closed.error(), "closing session " + id.ToString());
  }
  const auto session = record->SessionById(id);
  if (!session) return Fail(session.error());
  run.Output(store::ToJson(*session), "closed");
  return {};
}

Status Reopen(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto found = FindSession(*record, options.session);
  if (!found) return Fail(found.error());
  const SessionId id = found->id;
  if (const Status opened = record->ReopenSession(id, options.reason, NewStamp()); !opened) {
    return Fail(opened.error(), "opening session " + id.ToString() + " again");
  }
  const auto session = record->SessionById(id);
  if (!session) return Fail(session.error());
  run.Output(store::ToJson(*session), "open again");
  return {};
}

}  // namespace

void AddCommand_session(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "session", "Sessions: one subject before the camera, at one visit");
  auto options = std::make_shared<Options>();
  CLI::App* open = AddCommand(group, context, "open", "Open a session and print its id",
                              "striae -C trial session open --subject S001 --visit V1 --json");
  open->add_option("--subject", options->subject, "Pseudonym")->required();
  open->add_option("--visit", options->visit, "Name of the visit; it is made when new")->required();
  open->add_option("--date", options->date, "When it was, at the site: 2026-05-04 or 2026-05-04T10:30 (default: now)");
  open->add_option("--unscheduled", options->unscheduled,
                   "Why a visit is held that the plan does not name; noted as a deviation");
  open->add_option("--camera-clock-offset", options->clock_offset_s, "Camera clock minus UTC, seconds, as measured");
  OnRun(open, context, [options](Context& run) { return Open(run, *options); });

  CLI::App* list =
      AddCommand(group, context, "list", "List the sessions", "striae -C trial session list --subject S001");
  list->add_option("--subject", options->subject, "Only those of this subject");
  OnRun(list, context, [options](Context& run) { return List(run, *options); });

  CLI::App* close = AddCommand(group, context, "close", "Close a session; no photograph is added any more",
                               "striae -C trial session close 3f0c4f5e-8a55-4f0e-9d5e-0a6c3c1d2b10");
  close->add_option("SESSION", options->session, "The session's id")->required();
  OnRun(close, context, [options](Context& run) { return Close(run, *options); });

  CLI::App* reopen = AddCommand(
      group, context, "reopen", "Open a closed session again",
      "striae -C trial session reopen 3f0c4f5e-8a55-4f0e-9d5e-0a6c3c1d2b10 --reason \"a photograph was forgotten\"");
  reopen->add_option("SESSION", options->session, "The session's id")->required();
  reopen->add_option("--reason", options->reason, "Why")->required();
  OnRun(reopen, context, [options](Context& run) { return Reopen(run, *options); });
}

}  // namespace striae::app
