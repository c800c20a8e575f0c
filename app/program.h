// What `striae` and its parts have in common: the shared options, parsing, and the way from an outcome to
// CONTRACT's exit codes.
#pragma once

#include <string>

#include "app/command.h"

namespace striae::app {

/// A program of the commands that `add` adds; `version` gives the text of --version.
int RunProgram(int argc, char** argv, void (*add)(CLI::App& root, Context& context), std::string (*version)());

}  // namespace striae::app
