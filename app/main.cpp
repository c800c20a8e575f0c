// striae: the program. Parses, runs the one command that was chosen, and turns its outcome into CONTRACT's exit codes.
#include <exception>
#include <iostream>

#include "app/catalogue.h"
#include "app/study.h"
#include "app/versions.h"

namespace {

using striae::ErrorCode;
using striae::app::Context;

constexpr int kDone = 0, kFailed = 1, kUsage = 2;

int Report(const striae::Error& error) {
  std::cerr << "striae: " << error.Describe() << " [" << ToString(error.code) << "]\n";
  return error.code == ErrorCode::kUsage ? kUsage : kFailed;
}

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
    return program.exit(e) == 0 ? kDone : kUsage;
  }
  const striae::Status status = context.action ? context.action(context) : striae::Status{};
  return status ? kDone : Report(status.error());
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return Run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::cerr << "striae: not enough memory; close other programs or use a smaller photograph\n";
  } catch (const std::exception& e) {
    std::cerr << "striae: internal error: " << e.what() << "; please report it with the command that you ran\n";
  }
  return kFailed;
}
