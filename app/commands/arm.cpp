// `striae arm add|list|assign`: the arms of the study.
#include "app/local_time.h"
#include "app/study.h"
#include "store/json.h"

namespace striae::app {
namespace {

struct Options {
  std::string name, title, subject, date, reason;
};

Status Add(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const store::Arm arm{NewId<store::ArmId>(), options.name, options.title};
  if (const Status added = store::AddArm(*record, arm, NewStamp()); !added) return Fail(added.error(), "adding an arm");
  run.Output(store::ToJson(arm), "arm " + arm.name);
  return {};
}

Status List(Context& run) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto arms = store::Arms(*record);
  if (!arms) return Fail(arms.error());
  nlohmann::json list = nlohmann::json::array();
  std::string text;
  for (const store::Arm& arm : *arms) {
    list.push_back(store::ToJson(arm));
    text += (text.empty() ? "" : "\n") + arm.name + "  " + arm.title;
  }
  run.Output({{"arms", list}}, text.empty() ? "no arms" : text);
  return {};
}

Status Assign(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto subject = record->SubjectByPseudonym(options.subject);
  if (!subject) return Fail(subject.error());
  const auto arm = store::ArmByName(*record, options.name);
  if (!arm) return Fail(arm.error());
  const store::Stamp stamp = NewStamp();
  const auto date = options.date.empty() ? Result<Date>(DayAt(stamp.now, stamp.zone)) : Date::Parse(options.date);
  if (!date) return Fail(date.error(), "--date");
  const Status assigned = store::AssignArm(*record, subject->id, arm->id, *date, options.reason, stamp);
  if (!assigned) return Fail(assigned.error(), "assigning an arm");
  run.Output({{"subject", subject->pseudonym}, {"arm", arm->name}, {"date", date->ToString()}},
             subject->pseudonym + " is in arm " + arm->name);
  return {};
}

}  // namespace

void AddCommand_arm(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "arm", "Arms of the study");
  auto options = std::make_shared<Options>();
  CLI::App* add =
      AddCommand(group, context, "add", "Add an arm", "striae -C trial arm add A --title \"standard care\"");
  add->add_option("NAME", options->name, "Short name")->required();
  add->add_option("--title", options->title, "What it is");
  OnRun(add, context, [options](Context& run) { return Add(run, *options); });
  OnRun(AddCommand(group, context, "list", "List the arms", "striae -C trial arm list"), context, List);
  CLI::App* assign =
      AddCommand(group, context, "assign", "Put a subject into an arm", "striae -C trial arm assign S001 A");
  assign->add_option("SUBJECT", options->subject, "Pseudonym")->required();
  assign->add_option("ARM", options->name, "The arm's name")->required();
  assign->add_option("--date", options->date, "Day of the assignment (default: today)");
  assign->add_option("--reason", options->reason, "Why, when the subject was in another arm");
  OnRun(assign, context, [options](Context& run) { return Assign(run, *options); });
}

}  // namespace striae::app
