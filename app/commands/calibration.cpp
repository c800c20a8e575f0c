// `striae calibration add`: a calibration file comes into force for a device.
#include "app/io/files.h"
#include "app/study.h"
#include "store/json.h"

namespace striae::app {
namespace {

struct Options {
  std::filesystem::path file;
  std::string device, valid_from, range;
};

Result<Device> ChooseDevice(store::Record& record, const Options& options) {
  if (options.range.empty()) return record.DeviceBySerial(options.device);
  const auto range = ParseRigRange(options.range);
  if (!range) return Fail(range.error(), "--range");
  return record.DeviceBySerial(options.device, *range);
}

Status Add(Context& run, const Options& options) {
  const auto valid_from = Date::Parse(options.valid_from);
  if (!valid_from) return Fail(valid_from.error(), "--valid-from");
  const auto bytes = ReadFile(options.file);
  if (!bytes) return Fail(bytes.error());
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto device = ChooseDevice(*record, options);
  if (!device) return Fail(device.error());
  const auto added = record->AddCalibration(NewId<CalibrationId>(), device->id, *bytes, *valid_from, NewStamp());
  if (!added) return Fail(added.error(), "adding calibration " + options.file.string());
  run.Output(store::ToJson(*added), "calibration of " + device->serial + " in force from " + valid_from->ToString());
  return {};
}

}  // namespace

void AddCommand_calibration(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "calibration", "Calibrations of the study's devices");
  auto options = std::make_shared<Options>();
  CLI::App* add = AddCommand(group, context, "add", "Put a calibration in force for a device from a day on",
                             "striae -C trial calibration add cal.json --device 6123456 --valid-from 2026-05-01");
  add->add_option("FILE", options->file, "Calibration, as 'striae calibrate' writes it")->required();
  add->add_option("--device", options->device, "Serial number of the device's camera body")->required();
  add->add_option("--valid-from", options->valid_from, "First day on which it counts (2026-05-01)")->required();
  add->add_option("--range", options->range, "small or large, when the body is registered with both");
  OnRun(add, context, [options](Context& run) { return Add(run, *options); });
}

}  // namespace striae::app
