// The commands of the study record, which app/front.cpp starts: without the libraries of the reconstruction they answer
// a fifth of a second sooner. The whole program has them too.
#include "app/catalogue.h"
#include "app/program.h"
#include "core/provenance.h"

int main(int argc, char** argv) {
  return striae::app::RunProgram(argc, argv, striae::app::AddRecordCommands,
                                 [] { return std::string(striae::StriaeVersion()); });
}
