// Devices that failed a check and have passed none of that kind since.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/result.h"
#include "store/device_checks.h"
#include "store/record.h"

namespace striae::app {

/// Devices whose newest check of some kind failed, for `status`.
struct OutOfTolerance {
  Device device;
  store::DeviceCheck failed;
};
Result<std::vector<OutOfTolerance>> DevicesOutOfTolerance(store::Record& record);
nlohmann::json ToJson(const std::vector<OutOfTolerance>& devices);
/// A line for each, empty when there is none.
std::string TextOf(const std::vector<OutOfTolerance>& devices);

}  // namespace striae::app
