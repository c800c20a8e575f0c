#include "app/out_of_tolerance.h"

#include <map>

namespace striae::app {

Result<std::vector<OutOfTolerance>> DevicesOutOfTolerance(store::Record& record) {
  const auto devices = record.Devices();
  if (!devices) return Fail(devices.error());
  std::vector<OutOfTolerance> all;
  for (const Device& device : *devices) {
    const auto checks = store::DeviceChecks(record, device.id);
    if (!checks) return Fail(checks.error());
    std::map<std::string, store::DeviceCheck> newest;
    for (const store::DeviceCheck& check : *checks) newest[check.kind] = check;
    for (auto& [kind, check] : newest) {
      if (!check.passed) all.push_back({device, check});
    }
  }
  return all;
}

nlohmann::json ToJson(const std::vector<OutOfTolerance>& devices) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [device, failed] : devices) {
    nlohmann::json entry = store::ToJson(failed);
    entry["serial"] = device.serial;
    entry["range"] = ToString(device.range);
    list.push_back(std::move(entry));
  }
  return list;
}

std::string TextOf(const std::vector<OutOfTolerance>& devices) {
  std::string text;
  for (const auto& [device, failed] : devices) {
    text += "DEVICE " + device.serial + " (" + std::string(ToString(device.range)) + ") failed its " + failed.kind +
            " check on " + Date::Of(failed.from).ToString() +
            ": what it measures is flagged until one is passed (striae verify history --device " + device.serial +
            ")\n";
  }
  return text;
}

}  // namespace striae::app
