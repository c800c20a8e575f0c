// `striae visit plan add|change|drop|list` and `striae visit list`: when each subject is due.
#include <charconv>
#include <tuple>

#include "app/local_time.h"
#include "app/study.h"
#include "store/json.h"

namespace striae::app {
namespace {

struct Options {
  std::string name, arm, window, reason, subject;
  std::optional<int> day;
};

/// "-3,+3" as {-3, 3}.
Result<std::pair<int, int>> ParseWindow(const std::string& text) {
  const auto number = [](std::string_view part) -> std::optional<int> {
    if (part.starts_with('+')) part.remove_prefix(1);
    int value = 0;
    const auto read = std::from_chars(part.data(), part.data() + part.size(), value);
    if (part.empty() || read.ec != std::errc() || read.ptr != part.data() + part.size()) return std::nullopt;
    return value;
  };
  const auto comma = text.find(',');
  const auto from = number(std::string_view(text).substr(0, comma));
  const auto to = comma == std::string::npos ? std::nullopt : number(std::string_view(text).substr(comma + 1));
  if (!from || !to) return Fail(ErrorCode::kUsage, "--window is days before and after the target: -3,+3");
  return std::pair(*from, *to);
}

std::string LineOf(const store::PlannedVisit& visit, const std::string& arm) {
  return visit.name + "  day " + std::to_string(visit.day) + "  window " + std::to_string(visit.window_from) + ",+" +
         std::to_string(visit.window_to) + (arm.empty() ? "" : "  arm " + arm);
}

Result<std::optional<store::ArmId>> ArmIdOf(store::Record& record, const std::string& name) {
  if (name.empty()) return std::optional<store::ArmId>();
  const auto arm = store::ArmByName(record, name);
  if (!arm) return Fail(arm.error());
  return std::optional(arm->id);
}

/// The visit in force of that name and arm.
Result<store::PlannedVisit> InForce(store::Record& record, const Options& options) {
  const auto arm = ArmIdOf(record, options.arm);
  if (!arm) return Fail(arm.error());
  const auto plan = store::VisitPlan(record);
  if (!plan) return Fail(plan.error());
  for (const store::PlannedVisit& visit : *plan) {
    if (visit.name == options.name && visit.arm == *arm) return visit;
  }
  return Fail(ErrorCode::kNotFound, "no visit " + options.name + " in the plan" +
                                        (options.arm.empty() ? " for all arms" : " of arm " + options.arm) +
                                        "; see 'striae visit plan list'");
}

Status Add(Context& run, const Options& options) {
  const auto window = ParseWindow(options.window.empty() ? "0,0" : options.window);
  if (!window) return Fail(window.error());
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto arm = ArmIdOf(*record, options.arm);
  if (!arm) return Fail(arm.error());
  const store::PlannedVisit visit{NewId<store::PlannedVisitId>(), options.name,  *arm,
                                  options.day.value_or(0),        window->first, window->second};
  if (const Status added = store::PlanVisit(*record, visit, NewStamp()); !added) {
    return Fail(added.error(), "planning a visit");
  }
  run.Output(store::ToJson(visit), LineOf(visit, options.arm));
  return {};
}

Status Change(Context& run, const Options& options, bool drop) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto before = InForce(*record, options);
  if (!before) return Fail(before.error());
  store::PlannedVisit visit = *before;
  visit.id = NewId<store::PlannedVisitId>();
  visit.day = options.day.value_or(visit.day);
  if (!options.window.empty()) {
    const auto window = ParseWindow(options.window);
    if (!window) return Fail(window.error());
    std::tie(visit.window_from, visit.window_to) = *window;
  }
  const Status done = drop ? store::DropVisit(*record, before->id, visit.id, options.reason, NewStamp())
                           : store::ReplanVisit(*record, before->id, visit, options.reason, NewStamp());
  if (!done) return Fail(done.error(), "changing the plan");
  run.Output(store::ToJson(visit), drop ? visit.name + " is no longer planned" : LineOf(visit, options.arm));
  return {};
}

Status ListPlan(Context& run) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto plan = store::VisitPlan(*record);
  if (!plan) return Fail(plan.error());
  const auto arms = store::Arms(*record);
  if (!arms) return Fail(arms.error());
  nlohmann::json list = nlohmann::json::array();
  std::string text;
  for (const store::PlannedVisit& visit : *plan) {
    std::string arm;
    for (const store::Arm& one : *arms) {
      if (visit.arm == one.id) arm = one.name;
    }
    nlohmann::json entry = store::ToJson(visit);
    entry["arm"] = arm.empty() ? nlohmann::json() : nlohmann::json(arm);
    list.push_back(std::move(entry));
    text += (text.empty() ? "" : "\n") + LineOf(visit, arm);
  }
  run.Output({{"plan", list}}, text.empty() ? "no visits are planned" : text);
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
  const store::Stamp stamp = NewStamp();
  const auto states = store::VisitStates(*record, DayAt(stamp.now, stamp.zone), only);
  if (!states) return Fail(states.error());
  nlohmann::json list = nlohmann::json::array();
  std::string text;
  for (const store::VisitState& state : *states) {
    list.push_back(store::ToJson(state));
    text += (text.empty() ? "" : "\n") + state.subject.pseudonym + "  " + state.visit.name + "  " +
            std::string(ToString(state.state));
    if (state.held) text += "  held " + state.held->ToString();
    if (state.target) {
      text += "  target " + state.target->ToString() + " (" + state.earliest->ToString() + " to " +
              state.latest->ToString() + ")";
    }
  }
  run.Output({{"visits", list}}, text.empty() ? "no visits are planned" : text);
  return {};
}

void AddPlan(CLI::App& group, Context& context, const std::shared_ptr<Options>& options) {
  CLI::App& plan = Group(group, "plan", "The visits that the protocol asks for");
  CLI::App* add =
      AddCommand(plan, context, "add", "Plan a visit", "striae -C trial visit plan add V2 --day 14 --window -3,+3");
  CLI::App* change = AddCommand(plan, context, "change", "Change the day or window of a planned visit",
                                "striae -C trial visit plan change V2 --window -5,+5 --reason \"amendment 1\"");
  CLI::App* drop = AddCommand(plan, context, "drop", "Take a visit out of the plan",
                              "striae -C trial visit plan drop V2 --reason \"amendment 1\"");
  for (CLI::App* command : {add, change, drop}) {
    command->add_option("VISIT", options->name, "Name of the visit")->required();
    command->add_option("--arm", options->arm, "Only for this arm");
  }
  add->add_option("--day", options->day, "Target day, counted from the subject's day 0")->required();
  change->add_option("--day", options->day, "New target day");
  for (CLI::App* command : {add, change}) {
    command->add_option("--window", options->window, "Days before and after the target that still count: -3,+3");
  }
  for (CLI::App* command : {change, drop}) command->add_option("--reason", options->reason, "Why")->required();
  OnRun(add, context, [options](Context& run) { return Add(run, *options); });
  OnRun(change, context, [options](Context& run) { return Change(run, *options, false); });
  OnRun(drop, context, [options](Context& run) { return Change(run, *options, true); });
  OnRun(AddCommand(plan, context, "list", "List the plan in force", "striae -C trial visit plan list"), context,
        ListPlan);
}

}  // namespace

void AddCommand_visit(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "visit", "The visit plan, and where each subject stands in it");
  auto options = std::make_shared<Options>();
  AddPlan(group, context, options);
  CLI::App* list = AddCommand(group, context, "list", "Say for each subject and planned visit: due, late, done ...",
                              "striae -C trial visit list --subject S001");
  list->add_option("--subject", options->subject, "Only this subject");
  OnRun(list, context, [options](Context& run) { return List(run, *options); });
}

}  // namespace striae::app
