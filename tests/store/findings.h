// What a check found, for tests.
#pragma once

#include "store/audit.h"
#include "tests/store/small_study.h"

namespace striae::testing {

/// A finding about that place with those words.
MATCHER_P2(Names, where, what, "") {
  for (const store::Finding& finding : arg.findings) {
    if (finding.where.find(where) != std::string::npos && finding.what.find(what) != std::string::npos) return true;
    *result_listener << finding.where << ": " << finding.what << "\n";
  }
  return false;
}

}  // namespace striae::testing
