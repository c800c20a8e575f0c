// `striae device add|list`: the cameras with their gratings.
#include "app/study.h"
#include "store/json.h"

namespace striae::app {
namespace {

struct Options {
  std::string serial, range, model = "NIKON D90", lens = "AF-S NIKKOR 50mm f/1.8G";
};

Status Add(Context& run, const Options& options) {
  const auto range = ParseRigRange(options.range);
  if (!range) return Fail(range.error(), "--range");
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const Device device{NewId<DeviceId>(), options.serial, *range, options.model, options.lens};
  if (const Status added = record->AddDevice(device, NewStamp()); !added) {
    return Fail(added.error(), "adding a device");
  }
  run.Output(store::ToJson(device), "device " + device.serial + "; next: striae calibration add cal.json --device " +
                                        device.serial + " --valid-from DATE");
  return {};
}

Status List(Context& run) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto devices = record->Devices();
  if (!devices) return Fail(devices.error());
  nlohmann::json list = nlohmann::json::array();
  std::string text;
  for (const Device& device : *devices) {
    const auto calibrations = record->Calibrations(device.id);
    if (!calibrations) return Fail(calibrations.error());
    nlohmann::json entry = store::ToJson(device);
    entry["calibrations"] = nlohmann::json::array();
    for (const auto& calibration : *calibrations) entry["calibrations"].push_back(store::ToJson(calibration));
    list.push_back(std::move(entry));
    text += (text.empty() ? "" : "\n") + device.serial + "  " + std::string(ToString(device.range)) + "  " +
            device.model + "  " + device.lens + "  calibrations: " + std::to_string(calibrations->size());
  }
  run.Output({{"devices", list}}, text.empty() ? "no devices yet" : text);
  return {};
}

}  // namespace

void AddCommand_device(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "device", "Cameras with their grating projectors");
  auto options = std::make_shared<Options>();
  CLI::App* add = AddCommand(group, context, "add", "Register a camera body with its grating",
                             "striae -C trial device add --serial 6123456 --range small");
  add->add_option("--serial", options->serial, "Serial number of the camera body, as EXIF has it")->required();
  add->add_option("--range", options->range, "small (1 m) or large (2 m)")->required();
  add->add_option("--model", options->model, "Camera model")->capture_default_str();
  add->add_option("--lens", options->lens, "Lens")->capture_default_str();
  OnRun(add, context, [options](Context& run) { return Add(run, *options); });

  CLI::App* list =
      AddCommand(group, context, "list", "List the devices and their calibrations", "striae -C trial device list");
  OnRun(list, context, List);
}

}  // namespace striae::app
