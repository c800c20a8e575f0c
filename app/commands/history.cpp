// `striae history`: who changed something, when and why.
#include "app/study.h"
#include "store/json.h"

namespace striae::app {
namespace {

std::string LineOf(const store::AuditRow& row) {
  std::string line = std::to_string(row.sequence) + "  " + row.stamp.now.ToString() + "  " + row.stamp.user + "@" +
                     row.stamp.machine + "  " + row.action + " " + row.entity;
  if (row.action == "change") {
    line += "  " + row.field + ": " + row.old_value.value_or("-") + " -> " + row.new_value.value_or("-");
  } else if (row.new_value) {
    line += "  " + *row.new_value;
  }
  return row.reason.empty() ? line : line + "  (" + row.reason + ")";
}

Status Print(Context& run, const std::string& entity) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto rows = record->History(entity);
  if (!rows) return Fail(rows.error());
  nlohmann::json list = nlohmann::json::array();
  std::string text;
  for (const store::AuditRow& row : *rows) {
    list.push_back(store::ToJson(row));
    text += (text.empty() ? "" : "\n") + LineOf(row);
  }
  run.Output({{"history", list}}, text);
  return {};
}

}  // namespace

void AddCommand_history(CLI::App& root, Context& context) {
  CLI::App* command = AddCommand(root, context, "history", "Print every change of one thing: who, when, what and why",
                                 "striae -C trial history S001");
  auto entity = std::make_shared<std::string>();
  command->add_option("ENTITY", *entity, "Named as for 'striae show'")->required();
  OnRun(command, context, [entity](Context& run) { return Print(run, *entity); });
}

}  // namespace striae::app
