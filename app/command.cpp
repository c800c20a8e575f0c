#include "app/command.h"

#include <iostream>

namespace striae::app {

void Context::Output(const nlohmann::json& document, const std::string& text) {
  if (json) {
    std::cout << document.dump(1) << '\n';
  } else if (!text.empty()) {
    std::cout << text << '\n';
  }
}

void Context::Note(const std::string& message) const { std::cerr << message << '\n'; }

CLI::App* AddCommand(CLI::App& parent, Context& context, const std::string& name, const std::string& description,
                     const std::string& example) {
  CLI::App* command = parent.add_subcommand(name, description);
  command->footer("Example:\n  " + example);
  command->add_flag("--json", context.json, "Print exactly one JSON document on stdout");
  return command;
}

CLI::App& Group(CLI::App& root, const std::string& name, const std::string& description) {
  for (CLI::App* group : root.get_subcommands([&](const CLI::App* sub) { return sub->get_name() == name; })) {
    return *group;
  }
  CLI::App* group = root.add_subcommand(name, description);
  group->footer("Each explains itself: striae " + name + " COMMAND --help");
  group->require_subcommand(1);
  return *group;
}

void OnRun(CLI::App* command, Context& context, Context::Action action) {
  command->final_callback([&context, action = std::move(action)] { context.action = action; });
}

}  // namespace striae::app
