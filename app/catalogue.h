// The commands of the program; the definitions are generated from the files in app/commands/.
#pragma once

#include "app/command.h"

namespace striae::app {

void AddAllCommands(CLI::App& root, Context& context);
/// Those of the study record.
void AddRecordCommands(CLI::App& root, Context& context);

}  // namespace striae::app
