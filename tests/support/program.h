// Runs a program as a person would and keeps what it said.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace striae::testing {

struct Ran {
  int exit_code = -1;  ///< 128 + signal when it was killed
  std::string out, err;
  /// stdout as the one JSON document that --json promises; a discarded value (is_discarded()) when it is not.
  [[nodiscard]] nlohmann::json Json() const { return nlohmann::json::parse(out, nullptr, false); }
};

/// Runs a program with its arguments (no shell), in `folder` when given.
Ran RunProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments,
               const std::filesystem::path& folder = {});

/// True if a program of that name is on the PATH.
bool OnPath(const std::string& program);

}  // namespace striae::testing
