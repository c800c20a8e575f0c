// `striae process`: from the photographs of a session to surfaces and measurements in the record.
#include "app/command.h"
#include "app/names.h"
#include "app/pipeline.h"
#include "app/progress.h"
#include "app/study.h"

namespace striae::app {
namespace {

Status Process(Context& context, const std::string& session_text) {
  auto record = OpenStudy(context);
  if (!record) return Fail(record.error());
  std::optional<SessionId> session;
  if (!session_text.empty()) {
    const auto found = FindSession(*record, session_text);
    if (!found) return Fail(found.error());
    session = found->id;
  }
  ProgressBar bar;
  const auto done = ProcessCaptures(*record, session, [&](std::size_t ready, std::size_t all, const Capture& next) {
    bar.Show(ready, all, next.file_name);
  });
  bar.Clear();
  if (!done) return Fail(done.error());

  nlohmann::json document = {{"processed", nlohmann::json::array()}};
  std::string text;
  std::size_t failed = 0;
  for (const Processed& processed : *done) {
    document["processed"].push_back(ToJson(processed));
    text += (text.empty() ? "" : "\n") + Describe(processed);
    failed += processed.state == Processed::State::kFailed ? 1 : 0;
    if (!processed.warning.empty())
      context.Note("WRONG LABEL: " + processed.capture.file_name + ": " + processed.warning);
  }
  document["failed"] = failed;
  context.Output(document, done->empty() ? "nothing to process: no photograph has a role yet" : text);
  if (failed > 0) {
    return Fail(ErrorCode::kMeasurementRefused,
                std::to_string(failed) + " of " + std::to_string(done->size()) +
                    " photographs gave no result; the reasons are above and in the record");
  }
  return {};
}

}  // namespace

void AddCommand_process(CLI::App& root, Context& context) {
  CLI::App* command = AddCommand(root, context, "process", "Compute surfaces and measurements of imported photographs",
                                 "striae -C study process --session 0f8fad5b-d9cb-469f-a165-70867728950e");
  auto session = std::make_shared<std::string>();
  command->add_option("--session", *session, "Only this session (all of the study when left out)");
  OnRun(command, context, [session](Context& run) { return Process(run, *session); });
}

}  // namespace striae::app
