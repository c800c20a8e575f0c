// The commands of the program; the definition is generated from the files in app/commands/.
#pragma once

#include "app/command.h"

namespace striae::app {

void AddAllCommands(CLI::App& root, Context& context);

}  // namespace striae::app
