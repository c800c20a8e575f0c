// The whole program, which app/front.cpp starts.
#include "app/catalogue.h"
#include "app/program.h"
#include "app/versions.h"

int main(int argc, char** argv) {
  return striae::app::RunProgram(argc, argv, striae::app::AddAllCommands, striae::app::VersionText);
}
