// What lies in a study's quarantine and waits for a person.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "store/record.h"

namespace striae::app {

struct QuarantinedFile {
  std::string name;    ///< within quarantine/
  std::string origin;  ///< where it came from, as the note beside it says
  std::string message;
};

/// By name; without those whose photograph has come into the record meanwhile. A note that cannot be read is said so.
std::vector<QuarantinedFile> Quarantined(store::Record& record);

nlohmann::json ToJson(const std::vector<QuarantinedFile>& files);
/// "" when there is none.
std::string TextOf(const std::vector<QuarantinedFile>& files);

}  // namespace striae::app
