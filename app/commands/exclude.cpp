// `striae exclude`: a capture or a measurement that does not count. It stays, marked.
#include "app/study.h"
#include "store/annotations.h"

namespace striae::app {
namespace {

struct Options {
  std::string target, reason;
  bool undo = false;
};

Status Run(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto target = record->Find(options.target);
  if (!target) return Fail(target.error());
  const auto id = NewId<store::ExclusionId>();
  const Status done = options.undo ? store::Include(*record, id, *target, options.reason, NewStamp())
                                   : store::Exclude(*record, id, *target, options.reason, NewStamp());
  if (!done) return Fail(done.error(), options.undo ? "taking back an exclusion" : "excluding");
  run.Output(
      {{"id", id.ToString()}, {"about", {{"entity", target->entity}, {"id", target->id}}}, {"excluded", !options.undo}},
      target->entity + " " + target->id + (options.undo ? " counts again" : " is excluded, and stays in the record"));
  return {};
}

}  // namespace

void AddCommand_exclude(CLI::App& root, Context& context) {
  auto options = std::make_shared<Options>();
  CLI::App* command = AddCommand(root, context, "exclude", "Mark a capture or measurement that does not count",
                                 "striae -C trial exclude 3f0c4f5e --reason \"the subject moved\"");
  command->add_option("ID", options->target, "Id of the capture or the measurement")->required();
  command->add_option("--reason", options->reason, "Why")->required();
  command->add_flag("--undo", options->undo, "Take an exclusion back");
  OnRun(command, context, [options](Context& run) { return Run(run, *options); });
}

}  // namespace striae::app
