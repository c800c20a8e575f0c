// striae measure boundary SURFACE --box L T R B: an outline proposed by colour and shape, for the operator to confirm.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "analysis/wound/boundary.h"
#include "app/command.h"
#include "app/io/files.h"
#include "core/ply.h"
#include "core/provenance.h"

namespace striae::app {
namespace {

struct BoundaryCommand {
  std::filesystem::path surface, out;
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
  wound::BoundaryHints hints{.box = *box, .wound_strokes = {}, .skin_strokes = {}};
  if (!stroke->empty()) hints.wound_strokes.push_back(*stroke);
  if (!skin->empty()) hints.skin_strokes.push_back(*skin);
  const auto proposal = wound::ProposeBoundary(*surface, hints);
  if (!proposal) return Fail(proposal.error(), "looking for the wound's boundary on " + command.surface.string());
  nlohmann::json json = nlohmann::json::parse(ToJsonText(proposal->outline));
  json["drawn_by"] = "striae " + std::string(StriaeVersion()) + (command.by.empty() ? "" : " for " + command.by);
  json["method"] = "semi-automatic";
  json["confidence"] = proposal->confidence;
  if (Status done = WriteText(command.out, json.dump() + "\n"); !done) return done;
  char text[120];
  std::snprintf(text, sizeof text, "proposed an outline of %zu points, confidence %.2f: look at it before it counts",
                proposal->outline.polygon_px.size(), proposal->confidence);
  json["file"] = command.out.string();
  context.Output(json, text);
  return {};
}

}  // namespace

void AddCommand_measure_boundary(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "measure", "Measure on reconstructed surfaces");
  const auto options = std::make_shared<BoundaryCommand>();
  CLI::App* command =
      AddCommand(group, context, "boundary", "Propose a wound's outline from a rough box or a stroke in it",
                 "striae measure boundary calf.ply --box 2050 1400 2400 1760 --by anna --out calf.outline.json");
  command->add_option("surface", options->surface, "Surface of the photograph (PLY, as striae reconstruct writes it)")
      ->required();
  command->add_option("--box", options->box, "Around the wound: left top right bottom, sensor pixels")->expected(4);
  command->add_option("--stroke", options->stroke, "A line in the wound: col row col row ...")->expected(4, 400);
  command->add_option("--skin", options->skin, "A line on healthy skin: col row col row ...")->expected(2, 400);
  command->add_option("--by", options->by, "Who points, kept in the file");
  command->add_option("--out", options->out, "Outline file to write (JSON; edit it as any other)")->required();
  OnRun(command, context, [options](Context& c) { return Run(*options, c); });
}

}  // namespace striae::app
