// `striae status`: where the study stands and what is pending.
#include "app/device_checks.h"
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
  run.Output(document, TextOf(*failed) + TextOf(*study, *overview));
  return {};
}

}  // namespace

void AddCommand_status(CLI::App& root, Context& context) {
  CLI::App* command =
      AddCommand(root, context, "status", "Say where the study stands and what is pending", "striae -C trial status");
  OnRun(command, context, Print);
}

}  // namespace striae::app
