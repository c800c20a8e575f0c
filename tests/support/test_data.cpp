#include "tests/support/test_data.h"

#include <cstdlib>

namespace striae::testing {

std::filesystem::path TestData(const std::string& relative) {
  const char* folder = std::getenv("STRIAE_TEST_DATA");
  return std::filesystem::path(folder != nullptr ? folder : STRIAE_TEST_DATA) / relative;
}

bool HasTestData(const std::string& relative) { return std::filesystem::exists(TestData(relative)); }

}  // namespace striae::testing
