// The program under test.
#pragma once

#include "tests/support/program.h"

namespace striae::testing {

inline Ran Striae(const std::vector<std::string>& arguments) {
  return RunProgram(std::filesystem::path(STRIAE_BINARY_DIR) / "striae", arguments);
}

}  // namespace striae::testing
