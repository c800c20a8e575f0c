// `striae completion`: the shell's completion file, written from the program's own commands and options.
#include <sstream>

#include "app/command.h"

namespace striae::app {
namespace {

/// "name:words" for one command and, recursively, for those below it.
void AppendCases(const CLI::App& command, const std::string& path, std::ostream& out) {
  out << "    \"" << path << "\") words=\"";
  for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; })) {
    if (!sub->get_group().empty()) out << sub->get_name() << ' ';
  }
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) out << "--" << name << ' ';
  }
  out << "\" ;;\n";
  for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; })) {
    if (!sub->get_group().empty())
      AppendCases(*sub, path.empty() ? sub->get_name() : path + " " + sub->get_name(), out);
  }
}

/// A bash function that finds the chosen command among the words so far and offers its words, else file names.
std::string BashCompletion(const CLI::App& root) {
  std::ostringstream out;
  out << "# striae's completion; load it with: source <(striae completion bash)\n"
         "_striae() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} path='' next='' words='' i\n"
         "  for ((i = 1; i < COMP_CWORD; i++)); do\n"
         "    case ${COMP_WORDS[i]} in\n"
         "      -C) ((i++)) ;;\n"
         "      -*) ;;\n"
         "      *) next=\"${path:+$path }${COMP_WORDS[i]}\"\n"
         "         [[ -n $(_striae_words \"$next\") ]] && path=$next ;;\n"
         "    esac\n"
         "  done\n"
         "  words=$(_striae_words \"$path\")\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$current\") $(compgen -f -- \"$current\"))\n"
         "}\n"
         "_striae_words() {\n"
         "  local words=''\n"
         "  case $1 in\n";
  AppendCases(root, "", out);
  out << "  esac\n  echo \"$words\"\n}\ncomplete -o filenames -F _striae striae\n";
  return out.str();
}

}  // namespace

void AddCommand_completion(CLI::App& root, Context& context) {
  CLI::App* command = AddCommand(root, context, "completion", "Print the completion file of a shell",
                                 "source <(striae completion bash)");
  auto shell = std::make_shared<std::string>("bash");
  command->add_option("shell", *shell, "bash, or zsh (through its bashcompinit)")
      ->check(CLI::IsMember({"bash", "zsh"}))
      ->capture_default_str();
  OnRun(command, context, [&root, shell](Context& run) -> Status {
    const std::string prelude = *shell == "zsh" ? "autoload -U +X bashcompinit && bashcompinit\n" : "";
    const std::string text = prelude + BashCompletion(root);
    run.Output({{"shell", *shell}, {"script", text}}, text);
    return {};
  });
}

}  // namespace striae::app
