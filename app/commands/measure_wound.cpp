// striae measure wound SURFACE --outline OUTLINE: volume, areas and lengths of a wound.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "analysis/wound/wound.h"
#include "app/command.h"
#include "app/io/files.h"
#include "app/wound_pictures.h"
#include "core/outline.h"
#include "core/ply.h"
#include "report/picture.h"

namespace striae::app {
namespace {

struct WoundOptions {
  std::filesystem::path surface, outline, pictures, photograph;
};

std::string Line(const Measurement& m) {
  char text[120];
  std::snprintf(text, sizeof text, "  %-13s %10.3f +- %-8.3f %-4s", m.name.c_str(), m.value, m.uncertainty,
                m.unit.c_str());
  return text;
}

std::string Text(const AnalysisReport& report) {
  std::string text = "Wound below the virtual skin (standard uncertainties):\n";
  std::vector<std::string> reasons;  // each said once, with its number beside the values
  for (const Measurement& m : report.measurements) {
    text += Line(m);
    if (m.status == Measurement::Status::kFlagged) {
      const auto known = std::find(reasons.begin(), reasons.end(), m.reason);
      text += " flagged [" + std::to_string(known - reasons.begin() + 1) + "]";
      if (known == reasons.end()) reasons.push_back(m.reason);
    }
    text += '\n';
  }
  for (std::size_t k = 0; k < reasons.size(); ++k) text += "  [" + std::to_string(k + 1) + "] " + reasons[k] + '\n';
  const auto& skin = report.details["skin"];
  char method[200];
  std::snprintf(method, sizeof method, "  skin: %s from a ring %.0f to %.0f mm outside the line, %.2f mm rms",
                skin["model"].get<std::string>().c_str(), skin["gap_mm"].get<double>(),
                skin["gap_mm"].get<double>() + skin["ring_width_mm"].get<double>(), skin["ring_rms_mm"].get<double>());
  return text + method;
}

Result<std::string> DrawOnPhotograph(const WoundOptions& options, const Surface& surface, const Outline& outline,
                                     const wound::WoundMaps& maps) {
  const auto photograph = PhotographOfSurface(options.photograph, surface);
  if (!photograph) return Fail(photograph.error());
  const auto png = report::EncodePng(OutlineOnPhotograph(*photograph, outline, maps.cell_mm / maps.cell_px));
  if (!png) return Fail(png.error());
  const auto path = options.pictures / "photo.png";
  if (Status done = WriteFile(path, *png); !done) return Fail(done.error());
  return path.string();
}

Status Run(const WoundOptions& options, Context& context) {
  const auto surface_bytes = ReadFile(options.surface);
  if (!surface_bytes) return Fail(surface_bytes.error(), "reading the surface");
  const auto surface = DecodePly(*surface_bytes);
  if (!surface) return Fail(surface.error(), "reading the surface " + options.surface.string());
  const auto outline_bytes = ReadFile(options.outline);
  if (!outline_bytes) return Fail(outline_bytes.error(), "reading the outline");
  const auto outline = OutlineFromJson({reinterpret_cast<const char*>(outline_bytes->data()), outline_bytes->size()});
  if (!outline) return Fail(outline.error(), "reading the outline " + options.outline.string());

  wound::WoundMaps maps;
  auto report = wound::Measure(*surface, *outline, {}, options.pictures.empty() ? nullptr : &maps);
  if (!report) return Fail(report.error(), "measuring the wound on " + options.surface.string());
  for (const std::string& warning : Warnings(*surface)) FlagAll(*report, "the surface: " + warning);
  report->provenance.inputs = {{"surface", HashOf(*surface_bytes)}, {"outline", HashOf(*outline_bytes)}};
  if (!options.pictures.empty()) {
    const auto written = WriteWoundPictures(options.pictures, *surface, *outline, maps);
    if (!written) return Fail(written.error(), "drawing the wound");
    report->details["pictures"] = *written;
    if (!options.photograph.empty()) {
      const auto photo = DrawOnPhotograph(options, *surface, *outline, maps);
      if (!photo) return Fail(photo.error(), "drawing the wound");
      report->details["pictures"].push_back(*photo);
    }
  }
  context.Output(ToJson(*report), Text(*report));
  return {};
}

}  // namespace

void AddCommand_measure_wound(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "measure", "Measure on reconstructed surfaces");
  const auto options = std::make_shared<WoundOptions>();
  CLI::App* command = AddCommand(group, context, "wound", "Volume, areas and lengths of a wound inside a drawn outline",
                                 "striae measure wound calf.ply --outline calf.outline.json --json");
  command->add_option("surface", options->surface, "Surface of the photograph (PLY, as striae reconstruct writes it)")
      ->required();
  command->add_option("--outline", options->outline, "Outline of the wound in sensor pixels (JSON, LabelMe too)")
      ->required();
  CLI::Option* pictures = command->add_option(
      "--pictures", options->pictures, "Folder for boundary.png, depth.png (0 to 15 mm), view.png and sections.svg");
  command->add_option("--photo", options->photograph, "The photograph itself: photo.png shows the line on it")
      ->needs(pictures);
  OnRun(command, context, [options](Context& c) { return Run(*options, c); });
}

}  // namespace striae::app
