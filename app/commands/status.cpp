// `striae status`: where the study stands and what is pending.
#include "app/local_time.h"
#include "app/out_of_tolerance.h"
#include "app/quarantine.h"
#include "app/study.h"
#include "store/json.h"

namespace striae::app {
namespace {

std::string TextOf(const Study& study, const store::Overview& o) {
  const auto line = [](std::int64_t count, const std::string& what) {
    return count == 0 ? std::string() : "\n  " + std::to_string(count) + " " + what;
  };
  std::string text = study.protocol + "  " + study.title + "\n" + std::to_string(o.subjects) + " subjects (" +
                     std::to_string(o.subjects_with_consent) + " with active consent), " + std::to_string(o.visits) +
                     " visits, " + std::to_string(o.sessions) + " sessions, " + std::to_string(o.captures) +
                     " captures, " + std::to_string(o.measurements) + " measurements";
  const std::string pending =
      line(o.subjects - o.subjects_with_consent, "subjects without active consent") +
      line(o.open_sessions, "sessions open") +
      line(o.unassigned_captures, "captures without a role (import again with --as)") +
      line(o.wounds_without_outline, "wounds without an outline (striae outline)") +
      line(o.unprocessed_captures, "captures not processed (striae process)") +
      line(o.failed_captures, "captures whose processing failed (striae show SESSION says why)");
  return text + (pending.empty() ? "\nnothing pending" : "\npending:" + pending);
}

/// What people still have to do, beyond the counts of photographs.
struct Pending {
  std::vector<store::VisitState> visits;  ///< due, late or out of window
  std::size_t queries = 0, locks = 0, broken_signatures = 0, stale = 0;
};

Result<Pending> PendingOf(store::Record& record) {
  using State = store::VisitState::State;
  const store::Stamp stamp = NewStamp();
  auto states = store::VisitStates(record, DayAt(stamp.now, stamp.zone));
  if (!states) return Fail(states.error());
  std::erase_if(*states, [](const store::VisitState& visit) {
    return visit.state != State::kDue && visit.state != State::kLate && visit.state != State::kOutOfWindow;
  });
  const auto queries = store::Queries(record);
  if (!queries) return Fail(queries.error());
  const auto locks = store::Locks(record);
  if (!locks) return Fail(locks.error());
  const auto signatures = store::Signatures(record);
  if (!signatures) return Fail(signatures.error());
  const auto stale = store::StaleCaptures(record);
  if (!stale) return Fail(stale.error());
  Pending pending{*std::move(states), queries->size(), locks->size(), 0, stale->size()};
  for (const store::Signature& signature : *signatures) {
    pending.broken_signatures += signature.state == store::Signature::State::kBroken ? 1 : 0;
  }
  return pending;
}

nlohmann::json ToJson(const Pending& pending) {
  nlohmann::json visits = nlohmann::json::array();
  for (const store::VisitState& visit : pending.visits) visits.push_back(store::ToJson(visit));
  return {{"visits", visits},
          {"open_queries", pending.queries},
          {"locks", pending.locks},
          {"broken_signatures", pending.broken_signatures},
          {"stale_captures", pending.stale}};
}

std::string TextOf(const Pending& pending) {
  std::string text;
  for (const store::VisitState& visit : pending.visits) {
    text += "\n  " + visit.subject.pseudonym + "  " + visit.visit.name + "  " + std::string(ToString(visit.state)) +
            (visit.held ? ": held " + visit.held->ToString() + ", window " : ": window ") + visit.earliest->ToString() +
            " to " + visit.latest->ToString();
  }
  const auto line = [&](std::size_t count, const std::string& what) {
    if (count != 0) text += "\n  " + std::to_string(count) + " " + what;
  };
  line(pending.queries, "queries not closed (striae query list)");
  line(pending.locks, "locks (striae lock list)");
  line(pending.broken_signatures, "signatures broken by a later change (striae signatures)");
  line(pending.stale, "captures reassigned and not processed since (striae process)");
  return text.empty() ? text : "\nvisits, queries and signatures:" + text;
}

Status Print(Context& run) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto study = record->GetStudy();
  if (!study) return Fail(study.error());
  const auto sites = record->Sites();
  if (!sites) return Fail(sites.error());
  const auto overview = record->GetOverview();
  if (!overview) return Fail(overview.error());
  const auto failed = DevicesOutOfTolerance(*record);
  if (!failed) return Fail(failed.error());
  nlohmann::json document = store::ToJson(*overview);
  document["devices_out_of_tolerance"] = ToJson(*failed);
  document["study"] = store::ToJson(*study);
  document["sites"] = nlohmann::json::array();
  for (const Site& site : *sites) document["sites"].push_back(store::ToJson(site));
  const auto pending = PendingOf(*record);
  if (!pending) return Fail(pending.error());
  document["pending"] = ToJson(*pending);
  const auto quarantined = Quarantined(*record);
  document["quarantine"] = ToJson(quarantined);
  run.Output(document, TextOf(*failed) + TextOf(*study, *overview) + TextOf(*pending) + TextOf(quarantined));
  return {};
}

}  // namespace

void AddCommand_status(CLI::App& root, Context& context) {
  CLI::App* command =
      AddCommand(root, context, "status", "Say where the study stands and what is pending", "striae -C trial status");
  OnRun(command, context, Print);
}

}  // namespace striae::app
