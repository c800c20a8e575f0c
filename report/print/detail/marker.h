// ArUco markers as modules.
#pragma once

#include <string>

#include "core/image.h"
#include "core/result.h"

namespace striae::report::detail {

/// One pixel a module, black border of one module included; 1 = black. kUsage for a dictionary or number that is not
/// known (OpenCV's names; those that Striae prints).
Result<Mask> MarkerModules(const std::string& dictionary, int marker_id);

}  // namespace striae::report::detail
