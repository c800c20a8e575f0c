// `striae verify history`: the checks of a device over time, as a table and as a plot.
#include <fmt/format.h>

#include "app/io/files.h"
#include "app/study.h"
#include "report/picture.h"
#include "report/print/drift.h"
#include "store/device_checks.h"

namespace striae::app {
namespace {

using nlohmann::json;
using store::DeviceCheck;

struct Options {
  std::string device, range;
  std::filesystem::path plot;
};

struct Quantity {
  const char* kind;
  const char* name;   ///< of the figure in a check's result
  const char* title;  ///< for a person
};
constexpr Quantity kQuantities[] = {{"plane", "flatness", "Flatness of a plane"},
                                    {"ball", "form", "Form of a ball"},
                                    {"ball", "size", "Size error of a ball"},
                                    {"distance", "spacing", "Error of the distance of two balls"}};

std::vector<report::DriftPanel> Panels(const std::vector<DeviceCheck>& checks) {
  std::vector<report::DriftPanel> panels;
  for (const auto& [kind, name, title] : kQuantities) {
    report::DriftPanel panel{title, "mm", {}};
    for (const DeviceCheck& check : checks) {
      if (check.kind != kind) continue;
      const double value = check.result.at("worst_mm").at(name), limit = check.result.at("tolerances_mm").at(name);
      panel.points.push_back({check.from, value, limit, std::abs(value) <= limit});
    }
    panels.push_back(std::move(panel));
  }
  return panels;
}

Status WritePlot(const std::filesystem::path& file, const Device& device, const std::vector<DeviceCheck>& checks) {
  constexpr double kWidthPt = 520, kPixelsPerPt = 2;
  const std::string title =
      "Checks of device " + device.serial + " (" + std::string(ToString(device.range)) + " range)";
  const report::Drawing drawing = report::DrawDrift(title, Panels(checks), kWidthPt);
  const std::string kind = file.extension().string();
  if (kind == ".svg") return WriteText(file, report::SvgFile(drawing));
  // The newest check dates the file, so that the same checks give the same bytes.
  const auto bytes = kind == ".pdf" ? report::PdfDrawing(drawing, title, checks.back().at)
                                    : report::EncodePng(report::Rasterise(drawing, kPixelsPerPt));
  if (!bytes) return Fail(bytes.error());
  return WriteFile(file, *bytes);
}

std::string Line(const DeviceCheck& check) {
  std::string text = Date::Of(check.from).ToString() + "  " + fmt::format("{:<8}", check.kind);
  for (const auto& [kind, name, title] : kQuantities) {
    if (check.kind != kind) continue;
    text += fmt::format(" {} {:.3f} mm (tolerance {:g})", name, check.result.at("worst_mm").at(name).get<double>(),
                        check.result.at("tolerances_mm").at(name).get<double>());
  }
  return text + (check.passed ? "  passed" : "  FAILED") + "  by " + check.by + "  " + check.id.ToString().substr(0, 8);
}

Status History(Context& run, const Options& options) {
  const std::string kind = options.plot.extension().string();
  if (!options.plot.empty() && kind != ".png" && kind != ".pdf" && kind != ".svg") {
    return Fail(ErrorCode::kUsage, "--plot writes .png, .pdf or .svg, not '" + kind + "'");
  }
  std::optional<RigRange> range;
  if (!options.range.empty()) {
    const auto parsed = ParseRigRange(options.range);
    if (!parsed) return Fail(parsed.error(), "--range");
    range = *parsed;
  }
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto device = record->DeviceBySerial(options.device, range);
  if (!device) return Fail(device.error());
  const auto checks = store::DeviceChecks(*record, device->id);
  if (!checks) return Fail(checks.error());
  if (!options.plot.empty()) {
    if (checks->empty()) {
      return Fail(ErrorCode::kNotFound,
                  "device " + device->serial + " has no checks to plot yet; see 'striae verify plane'");
    }
    if (Status written = WritePlot(options.plot, *device, *checks); !written) return written;
  }
  json list = json::array();
  std::string text;
  for (const DeviceCheck& check : *checks) {
    list.push_back(store::ToJson(check));
    text += (text.empty() ? "" : "\n") + Line(check);
  }
  run.Output({{"device", device->serial}, {"range", ToString(device->range)}, {"checks", list}},
             text.empty() ? "no checks of device " + device->serial + " yet" : text);
  return {};
}

}  // namespace

void AddCommand_verify_history(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "verify", "Check the rig on a plane, a ball or two balls (VDI/VDE 2634 part 2)");
  auto options = std::make_shared<Options>();
  CLI::App* command = AddCommand(group, context, "history", "The checks of a device over time",
                                 "striae -C trial verify history --device 6123456 --plot drift.pdf");
  command->add_option("--device", options->device, "Serial number of the device's camera body")->required();
  command->add_option("--range", options->range, "small or large, when the body is registered with both");
  command->add_option("--plot", options->plot, "Drift plot to write: .png, .pdf or .svg");
  OnRun(command, context, [options](Context& run) { return History(run, *options); });
}

}  // namespace striae::app
