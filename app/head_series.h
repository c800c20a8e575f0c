// What a series of poses against one neutral capture says as a whole.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/measurement.h"
#include "core/result.h"

namespace striae::app {

struct HeadPose {
  std::string name;  ///< the surface's path
  Result<AnalysisReport> report;
};

struct HeadSummary {
  nlohmann::json document;  ///< {"analysis": "head-series", "poses", "range_of_motion", "repeatability"}
  std::string text;
};

/// Each `repeats` poses in a row are one pose taken again. Refused poses stand in the list with their reason, and in
/// no figure. The first pose's error when none was measured.
Result<HeadSummary> SummariseHeads(const std::vector<HeadPose>& poses, std::size_t repeats);

}  // namespace striae::app
