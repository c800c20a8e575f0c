#include "app/program.h"

#include "app/exit.h"
#include "app/study.h"

namespace striae::app {
namespace {

void Describe(CLI::App& program, Context& context, std::string (*version)()) {
  program.description(
      "Coloured 3D surfaces and measurements from one striped photograph.\n"
      "Each command explains itself: striae COMMAND --help");
  program.set_version_flag("--version", version);
  program.add_option("-C", context.study, "The study's folder")->type_name("DIR")->default_val(".");
  program.add_option_function<std::string>("--user", ActAs, "Who does this (else STRIAE_USER, else the login name)");
  program.require_subcommand(1);
  program.footer("Example:\n  striae reconstruct DSC_0001.JPG --calibration rig.json --out surface.ply");
}

}  // namespace

int RunProgram(int argc, char** argv, void (*add)(CLI::App& root, Context& context), std::string (*version)()) {
  return Guarded([&] {
    Context context;
    CLI::App program("", "striae");
    Describe(program, context, version);
    add(program, context);
    try {
      program.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
      return program.exit(e) == 0 ? kExitDone : kExitUsage;
    }
    const Status status = context.action ? context.action(context) : Status{};
    return status ? kExitDone : ReportError(status.error());
  });
}

}  // namespace striae::app
