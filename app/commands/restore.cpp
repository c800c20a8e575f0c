// `striae restore`: a study from its backup, or a second copy for another site.
#include "app/progress.h"
#include "app/study.h"
#include "store/backup.h"

namespace striae::app {
namespace {

struct Options {
  std::filesystem::path source, destination;
  bool branch = false;
};

Status Restore(Context& run, const Options& options) {
  store::RestoreOptions how;
  if (options.branch) how.branch = NewUuid();
  ProgressBar bar;
  how.progress = bar.AsProgress();
  const auto report = store::Restore(options.source, options.destination, how, NewStamp());
  bar.Clear();
  if (!report) return Fail(report.error(), "restore");
  run.Output(
      {{"study", options.destination.string()},
       {"head", ToText(report->head)},
       {"audit_rows", report->check.audit_rows},
       {"objects", report->objects},
       {"bytes", report->bytes},
       {"branch", options.branch}},
      std::to_string(report->objects) + " objects, " + std::to_string(report->check.audit_rows) + " audit rows in " +
          options.destination.string() + ", checked; head " + ToText(report->head) +
          (options.branch ? "\nthis copy goes its own way from here; bring both together with 'striae merge'" : ""));
  return {};
}

}  // namespace

void AddCommand_restore(CLI::App& root, Context& context) {
  CLI::App* command =
      AddCommand(root, context, "restore",
                 "Make a study from a backup, in a new folder, and check it. With --branch the new folder is a second "
                 "copy of the\n"
                 "study for another site or laptop: it writes a trail of its own and comes back by 'striae merge'.",
                 "striae restore /mnt/backup/trial-2026-11-22 trial\n  striae restore trial laptop/trial --branch");
  auto options = std::make_shared<Options>();
  command->add_option("SRC", options->source, "The backup, or a study's folder")->required();
  command->add_option("DEST", options->destination, "A folder that is empty or not there yet")->required();
  command->add_flag("--branch", options->branch, "A second copy, not the place of one that was lost");
  OnRun(command, context, [options](Context& run) { return Restore(run, *options); });
}

}  // namespace striae::app
