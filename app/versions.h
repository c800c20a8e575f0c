// What this build is made of, for `striae --version` and for provenance.
#pragma once

#include <string>

namespace striae::app {

/// "striae 0.1.0" and one line a library with the version in use.
std::string VersionText();

}  // namespace striae::app
