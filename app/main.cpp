// The whole program, which app/front.cpp starts. Parses, runs the one command that was chosen, and turns its outcome
// into CONTRACT's exit codes.
#include "app/catalogue.h"
#include "app/exit.h"
#include "app/study.h"
#include "app/versions.h"

namespace {

using striae::app::Context;

void Describe(CLI::App& program, Context& context) {
  program.description(
      "Coloured 3D surfaces and measurements from one striped photograph.\n"
      "Each command explains itself: striae COMMAND --help");
  program.set_version_flag("--version", [] { return striae::app::VersionText(); });
  program.add_option("-C", context.study, "The study's folder")->type_name("DIR")->default_val(".");
  program.add_option_function<std::string>("--user", striae::app::ActAs,
                                           "Who does this (else STRIAE_USER, else the login name)");
  program.require_subcommand(1);
  program.footer("Example:\n  striae reconstruct DSC_0001.JPG --calibration rig.json --out surface.ply");
}

int Run(int argc, char** argv) {
  Context context;
  CLI::App program("", "striae");
  Describe(program, context);
  striae::app::AddAllCommands(program, context);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return program.exit(e) == 0 ? striae::app::kExitDone : striae::app::kExitUsage;
  }
  const striae::Status status = context.action ? context.action(context) : striae::Status{};
  return status ? striae::app::kExitDone : striae::app::ReportError(status.error());
}

}  // namespace

int main(int argc, char** argv) {
  return striae::app::Guarded([&] { return Run(argc, argv); });
}
