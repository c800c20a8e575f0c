// Real photographs and the practice set: used where present, skipped with a clear line where not.
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace striae::testing {

/// A path under the test data: environment STRIAE_TEST_DATA, else the folder that CMake was given.
std::filesystem::path TestData(const std::string& relative);
bool HasTestData(const std::string& relative);

}  // namespace striae::testing

#define STRIAE_NEED_DATA(relative)                                                                       \
  if (!::striae::testing::HasTestData(relative)) {                                                       \
    GTEST_SKIP() << "no " << ::striae::testing::TestData(relative).string() << "; set STRIAE_TEST_DATA"; \
  }                                                                                                      \
  static_assert(true)
