// `striae verify plane|ball|distance`: does the rig still measure as it should? With -C and --device it is recorded.
#include <fmt/format.h>

#include "app/device_checks.h"
#include "app/io/files.h"
#include "app/study.h"
#include "app/verification.h"
#include "store/device_checks.h"

namespace striae::app {
namespace {

struct Options {
  std::vector<std::filesystem::path> files;
  std::filesystem::path calibration, outline;
  std::string range, device, date;
  double tolerance_mm = 0;
  CheckPlan plan;
};

Status FillPlan(const Options& options, CheckPlan& plan) {
  if (options.tolerance_mm > 0) plan.tolerance_mm = options.tolerance_mm;
  if (!options.range.empty()) {
    const auto range = ParseRigRange(options.range);
    if (!range) return Fail(range.error(), "--range");
    plan.range = *range;
  }
  if (options.outline.empty()) return {};
  const auto text = ReadText(options.outline);
  if (!text) return Fail(text.error());
  const auto outline = OutlineFromJson(*text);
  if (!outline) return Fail(outline.error(), options.outline.string());
  plan.options.outline = *outline;
  return {};
}

/// Once the figures are there: a device out of tolerance is a failure of the command, with all that it found printed.
Status Say(Context& run, const nlohmann::json& document, const std::string& more) {
  run.Output(document, CheckText(document) + more);
  if (document.at("passed").get<bool>()) return {};
  return Fail(ErrorCode::kMeasurementRefused,
              "the rig is out of tolerance: repeat the check; if it fails again, calibrate the rig anew");
}

Result<std::vector<CheckInput>> ReadAll(const Options& options, const std::optional<CalibrationFile>& calibration) {
  std::vector<CheckInput> inputs;
  for (const auto& file : options.files) {
    auto input = ReadCheckInput(file, calibration);
    if (!input) return Fail(input.error());
    inputs.push_back(*std::move(input));
  }
  return inputs;
}

Status Recorded(Context& run, const Options& options, CheckPlan plan,
                const std::optional<CalibrationFile>& given_calibration) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto device = record->DeviceBySerial(options.device, plan.range);
  if (!device) return Fail(device.error());
  const store::Stamp stamp = NewStamp();
  const auto when = ParseCheckTime(options.date, stamp.now);
  if (!when) return Fail(when.error(), "--date");
  plan.range = device->range;
  const auto calibration = CalibrationForCheck(*record, *device, Date::Of(when->from), given_calibration);
  if (!calibration) return Fail(calibration.error());
  const auto inputs = ReadAll(options, *calibration);
  if (!inputs) return Fail(inputs.error());
  for (const CheckInput& input : *inputs) {
    if (Status belongs = BelongsTo(*record, *device, input); !belongs) return belongs;
  }
  const auto document = RunCheck(*inputs, plan);
  if (!document) return Fail(document.error());
  store::DeviceCheck check;
  check.id = NewId<store::DeviceCheckId>();
  check.device = device->id;
  check.kind = plan.kind;
  check.from = when->from;
  check.until = when->until;
  check.passed = document->at("passed");
  check.evidence = inputs->front().sha256;
  check.result = *document;
  check.result["software"] = "striae " + std::string(StriaeVersion());
  const auto kept = store::AddDeviceCheck(*record, check, stamp);
  if (!kept) return Fail(kept.error(), "recording the check");
  nlohmann::json entry = store::ToJson(*kept);
  entry["device"] = device->serial;
  return Say(run, entry,
             "\nrecorded for device " + device->serial +
                 (kept->passed ? "" : "; run 'striae process' to flag what it measured since the last passed check"));
}

Status Verify(Context& run, const Options& options, CheckPlan plan) {
  if (Status filled = FillPlan(options, plan); !filled) return filled;
  std::optional<CalibrationFile> calibration;
  if (!options.calibration.empty()) {
    const auto bytes = ReadFile(options.calibration);
    if (!bytes) return Fail(bytes.error());
    auto parsed = ParseCalibrationFile(*bytes, options.calibration.string());
    if (!parsed) return Fail(parsed.error());
    calibration = *std::move(parsed);
  }
  if (!options.device.empty()) return Recorded(run, options, plan, calibration);
  if (!options.date.empty())
    return Fail(ErrorCode::kUsage, "--date belongs to a recorded check; give --device as well");
  const auto inputs = ReadAll(options, calibration);
  if (!inputs) return Fail(inputs.error());
  const auto document = RunCheck(*inputs, plan);
  if (!document) return Fail(document.error());
  return Say(run, *document, "");
}

CLI::App* AddKind(CLI::App& group, Context& context, const std::string& kind, const std::string& description,
                  const std::string& example, const std::shared_ptr<Options>& options) {
  CLI::App* command = AddCommand(group, context, kind, description, example);
  command->add_option("FILE", options->files, "Surfaces (PLY) or photographs of the artefact")->required();
  command->add_option("--calibration", options->calibration, "Calibration (JSON) that photographs are measured with");
  command->add_option("--outline", options->outline, "The artefact in sensor pixels (JSON), else it is looked for");
  command->add_option("--range", options->range, "small or large: whose tolerances count");
  command->add_option("--tolerance-mm", options->tolerance_mm, "Limit instead of the range's")
      ->check(CLI::PositiveNumber);
  command->add_option("--seed", options->plan.options.seed, "Of the search")->capture_default_str();
  command->add_option("--device", options->device, "Record the check in the study, for the device of this serial");
  command->add_option("--date", options->date, "When it was done, if not now: 2026-05-04 or 2026-05-04T07:08:09.000Z");
  options->plan.kind = kind;
  OnRun(command, context, [options](Context& run) { return Verify(run, *options, options->plan); });
  return command;
}

void AddDiameter(CLI::App& command, Options& options) {
  command.add_option("--diameter-mm", options.plan.diameter_mm, "Calibrated diameter of a ball")
      ->required()
      ->check(CLI::PositiveNumber);
}

}  // namespace

void AddCommand_verify(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "verify", "Check the rig on a plane, a ball or two balls (VDI/VDE 2634 part 2)");
  AddKind(group, context, "plane", "Flatness of a plate", "striae verify plane DSC_0042.JPG --calibration small.json",
          std::make_shared<Options>());
  const auto ball = std::make_shared<Options>();
  AddDiameter(*AddKind(group, context, "ball", "Form and size of a ball",
                       "striae -C trial verify ball DSC_0043.JPG --diameter-mm 60.012 --device 6123456", ball),
              *ball);
  const auto distance = std::make_shared<Options>();
  CLI::App* command = AddKind(group, context, "distance", "Distance of two balls (ball bar)",
                              "striae verify distance bar.ply --diameter-mm 60.012 --distance-mm 150.034", distance);
  AddDiameter(*command, *distance);
  command->add_option("--distance-mm", distance->plan.distance_mm, "Calibrated distance of the balls' centres")
      ->required()
      ->check(CLI::PositiveNumber);
}

}  // namespace striae::app
