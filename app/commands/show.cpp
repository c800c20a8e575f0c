// `striae show`: anything in the record, with what it came from and what came from it.
#include "app/study.h"

namespace striae::app {
namespace {

/// What one line says of a single value; nothing for null and for an empty text.
std::string Said(const nlohmann::json& value) {
  if (value.is_null()) return {};
  return value.is_string() ? value.get<std::string>() : value.dump();
}

/// JSON as indented lines for a person; `--json` has the document itself.
void Append(const nlohmann::json& value, const std::string& indent, std::string& text) {
  for (const auto& [key, entry] : value.items()) {
    std::string name = indent;
    name += value.is_array() ? "-" : key + ":";
    if (entry.is_structured() && !entry.empty()) {
      text.append(name).append("\n");
      Append(entry, indent + "  ", text);
    } else if (const std::string said = entry.is_structured() ? "" : Said(entry); !said.empty()) {
      text.append(name).append(" ").append(said).append("\n");
    }
  }
}

Status Show(Context& run, const std::string& id, const std::string& as_of) {
  auto record = OpenStudyAsOf(run, as_of);
  if (!record) return Fail(record.error());
  const auto described = record->Describe(id);
  if (!described) return Fail(described.error());
  std::string text;
  Append(*described, "", text);
  if (!text.empty()) text.pop_back();
  run.Output(*described, text);
  return {};
}

}  // namespace

void AddCommand_show(CLI::App& root, Context& context) {
  CLI::App* command = AddCommand(root, context, "show", "Show one thing with all that it came from and led to",
                                 "striae -C trial show S001");
  auto id = std::make_shared<std::string>();
  command
      ->add_option("ID", *id,
                   "A pseudonym, a device's serial, a SHA-256, or the id (or its first eight or more characters) of a "
                   "session, capture, report or measurement")
      ->required();
  auto as_of = std::make_shared<std::string>();
  command->add_option("--as-of", *as_of, "As the study stood then, UTC: 2026-05-04T12:00:00Z");
  OnRun(command, context, [id, as_of](Context& run) { return Show(run, *id, *as_of); });
}

}  // namespace striae::app
