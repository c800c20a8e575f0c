// `striae check`: proof that nothing in the study is missing or altered, and the repair of what a kill has left.
#include "store/check.h"

#include <algorithm>
#include <sstream>

#include "app/io/files.h"
#include "app/progress.h"
#include "app/study.h"
#include "store/json.h"
#include "store/repair.h"

namespace striae::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string head, save_head;
  bool repair = false;
  fs::path from;
};

/// --head: NUMBER:HASH, or a file with one head a line as --save-head writes it.
Result<std::vector<store::AuditHead>> ReadHeads(const std::string& text) {
  std::vector<store::AuditHead> heads;
  if (text.empty()) return heads;
  std::error_code code;
  std::string lines = text;
  if (fs::is_regular_file(text, code)) {
    auto read = ReadText(text);
    if (!read) return Fail(read.error());
    lines = *std::move(read);
  }
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line);) {
    if (line.empty()) continue;
    const auto head = store::ParseHead(line);
    if (!head) return Fail(ErrorCode::kUsage, "--head: " + head.error().message + ", or a file with such lines");
    heads.push_back(*head);
  }
  if (heads.empty()) return Fail(ErrorCode::kUsage, "--head: " + text + " is empty");
  return heads;
}

Status SaveHeads(const std::string& path, const store::CheckReport& report) {
  std::string text;
  for (const store::AuditHead& head : report.heads) text += ToText(head) + "\n";
  return WriteText(path, text);
}

std::string TextOf(const store::CheckReport& report, std::size_t errors) {
  std::string text;
  for (const store::Finding& finding : report.findings) {
    text += finding.severity == store::Finding::Severity::kError ? "ERROR   " : "warning ";
    text.append(finding.where).append(" ").append(finding.what).append("\n");
  }
  return text + std::to_string(report.audit_rows) + " audit rows, " + std::to_string(report.objects) +
         " objects; head " + ToText(report.head) + (errors == 0 ? "\npassed" : "\nFAILED");
}

/// What was settled; the bar is shown meanwhile.
Result<std::vector<store::Repaired>> RepairFirst(Context& run, store::Record& record, const Options& options,
                                                 ProgressBar& bar) {
  if (!options.repair) return std::vector<store::Repaired>{};
  store::RepairOptions how;
  if (!options.from.empty()) how.from = options.from;
  how.progress = bar.AsProgress();
  auto done = store::Repair(record, how, NewStamp());
  bar.Clear();
  if (done) {
    for (const auto& step : *done) run.Note("repaired " + step.where + ": " + step.what);
  }
  return done;
}

Status Check(Context& run, const Options& options) {
  store::CheckOptions how;
  auto expected = ReadHeads(options.head);
  if (!expected) return Fail(expected.error());
  if (!options.from.empty() && !options.repair) return Fail(ErrorCode::kUsage, "--from goes with --repair");
  how.expected = *std::move(expected);
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  ProgressBar bar;
  const auto repaired = RepairFirst(run, *record, options, bar);
  if (!repaired) return Fail(repaired.error(), "repairing");
  how.progress = bar.AsProgress();
  const auto report = store::Check(*record, how);
  bar.Clear();
  if (!report) return Fail(report.error());
  const auto errors = std::count_if(report->findings.begin(), report->findings.end(), [](const auto& finding) {
    return finding.severity == store::Finding::Severity::kError;
  });
  nlohmann::json document = store::ToJson(*report);
  document["head_text"] = ToText(report->head);
  document["repaired"] = nlohmann::json::array();
  for (const auto& step : *repaired) document["repaired"].push_back({{"where", step.where}, {"what", step.what}});
  run.Output(document, TextOf(*report, static_cast<std::size_t>(errors)));
  if (!options.save_head.empty() && errors == 0) {
    if (auto saved = SaveHeads(options.save_head, *report); !saved) return saved;
  }
  if (errors != 0) {
    return Fail(ErrorCode::kRecordDamaged, "the study does not pass: " + std::to_string(errors) +
                                               " errors, each named above; keep this copy as it is for the inquiry");
  }
  return {};
}

}  // namespace

void AddCommand_check(CLI::App& root, Context& context) {
  CLI::App* command = AddCommand(
      root, context, "check",
      "Verify the audit trail, every row and every file of the study. With --repair, first settle what a program that\n"
      "was stopped has left: unfinished files and objects without a row go to the study's quarantine folder, nothing\n"
      "with content is deleted, and each step is in the audit trail.",
      "striae -C trial check --save-head site-file/head.txt\n  striae -C trial check --head site-file/head.txt\n"
      "  striae -C trial check --repair --from /mnt/backup/trial");
  auto options = std::make_shared<Options>();
  command
      ->add_option("--head", options->head,
                   "The head that an earlier check printed (NUMBER:HASH) or saved: shows that the trail was not cut")
      ->type_name("HEAD|FILE");
  command->add_option("--save-head", options->save_head, "Write the heads to this file when the study passes")
      ->type_name("FILE");
  command->add_flag("--repair", options->repair, "Settle what a program that was stopped has left");
  command->add_option("--from", options->from, "With --repair: take missing or damaged files from this copy")
      ->type_name("DIR");
  OnRun(command, context, [options](Context& run) { return Check(run, *options); });
}

}  // namespace striae::app
