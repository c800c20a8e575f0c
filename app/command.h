// How a command of the program is declared, and what it is given when it runs.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "core/result.h"

namespace striae::app {

/// Options that every command shares, and the way out for what it says.
class Context {
 public:
  bool json = false;            ///< --json: exactly one JSON document on stdout
  std::filesystem::path study;  ///< -C DIR; the current folder when not given

  /// The command's result: `document` with --json, else `text` (a final newline is added). Call exactly once.
  void Output(const nlohmann::json& document, const std::string& text);
  /// A line for the person at the terminal: stderr, never mixed with the result.
  void Note(const std::string& message) const;

  using Action = std::function<Status(Context&)>;
  /// Set by the command that was chosen; main runs it after parsing.
  Action action;
};

/// Adds a sub-command with its description and an example for --help; `--json` is added to each.
/// `parent` is the program or a group ("measure", "dicom") from Group().
CLI::App* AddCommand(CLI::App& parent, Context& context, const std::string& name, const std::string& description,
                     const std::string& example);

/// The group command of that name ("measure", "dicom", "subject"); made when it is not there yet.
CLI::App& Group(CLI::App& root, const std::string& name, const std::string& description);

/// Says what the command does once it has been chosen and its options are parsed. Options live in a
/// std::shared_ptr<Options> that the caller's lambda captures.
void OnRun(CLI::App* command, Context& context, Context::Action action);

}  // namespace striae::app
