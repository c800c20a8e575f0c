// striae measure boundary SURFACE --box L T R B: an outline proposed by colour and shape, for the operator to confirm.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/wound/boundary.h"
#include "app/command.h"
#include "app/io/files.h"
#include "app/wound_pictures.h"
#include "core/outline.h"
#include "core/ply.h"
#include "core/provenance.h"
#include "report/picture.h"

namespace striae::app {
namespace {

struct BoundaryCommand {
  std::filesystem::path surface, photograph, picture, out;
  std::filesystem::path outline;
  std::vector<double> box, stroke, skin;
  std::string by;
};

Result<std::vector<Eigen::Vector2d>> Pairs(const std::vector<double>& numbers, const char* option) {
  if (numbers.size() % 2 != 0) {
    return Fail(ErrorCode::kUsage, std::string(option) + " needs columns and rows in turn");
  }
  std::vector<Eigen::Vector2d> points;
  for (std::size_t k = 0; k + 1 < numbers.size(); k += 2) points.emplace_back(numbers[k], numbers[k + 1]);
  return points;
}

nlohmann::json AsJson(const wound::BoundaryProposal& proposal, const wound::BoundaryRepeatability& repeats,
                      const BoundaryCommand& command) {
  nlohmann::json file = nlohmann::json::parse(ToJsonText(proposal.outline));
  file["drawn_by"] = "striae " + std::string(StriaeVersion()) + (command.by.empty() ? "" : " for " + command.by);
  file["method"] = "semi-automatic";
  file["colours"] = command.photograph.empty() ? "surface" : "photograph";
  file["confidence"] = proposal.confidence;
  file["area_cm2"] = proposal.area_mm2 / 100;
  file["repeatability"] = {{"shaken_mm", repeats.shaken_mm},
                           {"tried", repeats.tried},
                           {"found", repeats.found},
                           {"area_cv_percent", 100 * repeats.area_cv},
                           {"line_sd_mm", repeats.line_sd_mm}};
  return file;
}

Status Run(const BoundaryCommand& command, Context& context) {
  const auto bytes = ReadFile(command.surface);
  if (!bytes) return Fail(bytes.error(), "reading the surface");
  const auto surface = DecodePly(*bytes);
  if (!surface) return Fail(surface.error(), "reading the surface " + command.surface.string());
  const auto box = Pairs(command.box, "--box"), stroke = Pairs(command.stroke, "--stroke"),
             skin = Pairs(command.skin, "--skin");
  for (const auto* points : {&box, &stroke, &skin}) {
    if (!*points) return Fail(points->error());
  }
  if (!command.picture.empty() && command.photograph.empty()) {
    return Fail(ErrorCode::kUsage, "--picture draws on the photograph: name it by --photo");
  }
  wound::BoundaryHints hints;
  hints.box = *box;
  std::string drawn_text;
  if (!command.outline.empty()) {
    const auto text = ReadText(command.outline);
    if (!text) return Fail(text.error(), "reading the outline");
    drawn_text = *text;
    const auto drawn = OutlineFromJson(*text);
    if (!drawn) return Fail(drawn.error(), "reading the outline " + command.outline.string());
    hints.drawn = *drawn;
  }
  if (!stroke->empty()) hints.wound_strokes.push_back(*stroke);
  if (!skin->empty()) hints.skin_strokes.push_back(*skin);
  std::optional<ImageRgb> photograph;
  if (!command.photograph.empty()) {
    auto read = PhotographOfSurface(command.photograph, *surface);
    if (!read) return Fail(read.error());
    photograph = *std::move(read);
  }
  const ImageRgb* colours = photograph ? &*photograph : nullptr;
  const auto proposal = wound::ProposeBoundary(*surface, hints, {}, colours);
  if (!proposal) return Fail(proposal.error(), "looking for the wound's boundary on " + command.surface.string());
  const auto repeats = wound::RepeatBoundary(*surface, hints, *proposal, {}, colours);
  nlohmann::json file = AsJson(*proposal, repeats, command);
  if (!drawn_text.empty()) file["drawn"] = nlohmann::json::parse(drawn_text);  // both are kept, with who drew them
  if (Status done = WriteText(command.out, file.dump() + "\n"); !done) return done;
  if (!command.picture.empty()) {
    const auto png = report::EncodePng(OutlineOnPhotograph(*photograph, proposal->outline, proposal->pixel_mm));
    if (!png) return Fail(png.error());
    if (Status done = WriteFile(command.picture, *png); !done) return done;
  }
  const std::string text = fmt::format(
      "proposed an outline of {} points around {:.2f} cm2, confidence {:.2f}\n"
      "  pointed at anew, each point {:.1f} mm off: line {:.2f} mm (sd), area {:.1f} % (CV), found in {} of {}\n"
      "look at it before it counts",
      proposal->outline.polygon_px.size(), proposal->area_mm2 / 100, proposal->confidence, repeats.shaken_mm,
      repeats.line_sd_mm, 100 * repeats.area_cv, repeats.found, repeats.tried);
  file["file"] = command.out.string();
  context.Output(file, text);
  return {};
}

}  // namespace

void AddCommand_measure_boundary(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "measure", "Measure on reconstructed surfaces");
  const auto options = std::make_shared<BoundaryCommand>();
  CLI::App* command = AddCommand(
      group, context, "boundary", "Propose a wound's outline from a rough box or a stroke in it",
      "striae measure boundary calf.ply --photo calf.jpg --box 2050 1400 2400 1760 --by anna --out calf.outline.json");
  command->add_option("surface", options->surface, "Surface of the photograph (PLY, as striae reconstruct writes it)")
      ->required();
  command->add_option("--box", options->box, "Around the wound: left top right bottom, sensor pixels")->expected(4);
  command->add_option("--stroke", options->stroke, "A line in the wound: col row col row ...")->expected(4, 400);
  command->add_option("--skin", options->skin, "A line on healthy skin: col row col row ...")->expected(2, 400);
  command->add_option("--outline", options->outline, "A drawn outline: it is moved to the edge within 2 mm of it")
      ->excludes("--box");
  command->add_option("--photo", options->photograph,
                      "The photograph itself: its colours see steep walls that the surface lacks (recommended)");
  command->add_option("--picture", options->picture, "PNG to write: the line on the photograph");
  command->add_option("--by", options->by, "Who points, kept in the file");
  command->add_option("--out", options->out, "Outline file to write (JSON; edit it as any other)")->required();
  OnRun(command, context, [options](Context& c) { return Run(*options, c); });
}

}  // namespace striae::app
