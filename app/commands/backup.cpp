// `striae backup`: a whole copy of the study, taken while others work with it.
#include "store/backup.h"

#include "app/progress.h"
#include "app/study.h"

namespace striae::app {
namespace {

Status Backup(Context& run, const std::filesystem::path& destination) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  ProgressBar bar;
  const auto report = store::Backup(*record, destination, bar.AsProgress(), NewStamp());
  bar.Clear();
  if (!report) return Fail(report.error(), "backup");
  run.Output({{"backup", destination.string()},
              {"head", ToText(report->head)},
              {"audit_rows", report->check.audit_rows},
              {"objects", report->objects},
              {"bytes", report->bytes}},
             std::to_string(report->objects) + " objects, " + std::to_string(report->check.audit_rows) +
                 " audit rows in " + destination.string() + ", checked; head " + ToText(report->head));
  return {};
}

}  // namespace

void AddCommand_backup(CLI::App& root, Context& context) {
  CLI::App* command = AddCommand(
      root, context, "backup",
      "Copy the whole study to a new folder and check the copy. Others may go on working. An interrupted backup holds\n"
      "a file UNFINISHED and no study.db.",
      "striae -C trial backup /mnt/backup/trial-2026-11-22");
  auto destination = std::make_shared<std::filesystem::path>();
  command->add_option("DEST", *destination, "A folder that is empty or not there yet")->required();
  OnRun(command, context, [destination](Context& run) { return Backup(run, *destination); });
}

}  // namespace striae::app
