// Where a derived value came from, so that every number leads back to its photograph.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/hex.h"

namespace striae {

struct ProvenanceInput {
  std::string name;  ///< what it is: "photograph", "calibration", "outline", "surface"
  Sha256 sha256;
};

struct Provenance {
  std::string software = "striae";
  std::string version;
  std::vector<ProvenanceInput> inputs;
  nlohmann::json parameters = nlohmann::json::object();
};

/// The version that CMake built, e.g. "0.1.0".
std::string_view StriaeVersion();

}  // namespace striae
