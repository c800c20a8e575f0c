// striae measure head NEUTRAL POSE: the head's rotation against the torso between two captures.
#include <filesystem>
#include <memory>
#include <sstream>
#include <utility>

#include "analysis/head/angles.h"
#include "analysis/head/measure.h"
#include "app/command.h"
#include "app/io/files.h"
#include "core/ply.h"

namespace striae::app {
namespace {

struct HeadOptions {
  std::filesystem::path neutral, pose;
};

struct LoadedSurface {
  Surface surface;
  Sha256 sha256;
};

Result<LoadedSurface> Load(const std::filesystem::path& path, const std::string& what) {
  const auto bytes = ReadFile(path);
  if (!bytes) return Fail(bytes.error(), "reading the " + what + " surface");
  auto surface = DecodePly(*bytes);
  if (!surface) return Fail(surface.error(), "reading the " + what + " surface " + path.string());
  return LoadedSurface{std::move(*surface), HashOf(*bytes)};
}

std::string Text(const AnalysisReport& report) {
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(1);
  text << "Head against torso, from the neutral to the other capture:\n";
  for (const Measurement& m : report.measurements) {
    text << "  " << m.name << std::string(m.name.size() < 12 ? 12 - m.name.size() : 0, ' ') << m.value << " +- "
         << m.uncertainty << " deg   " << head::InWords(m.name, m.value);
    if (m.status == Measurement::Status::kFlagged) text << "   FLAGGED: " << m.reason;
    text << '\n';
  }
  text.precision(2);
  for (const char* part : {"head", "torso"}) {
    text << "  " << part << ": " << report.details["residual_mm"][part].get<double>() << " mm left, overlap "
         << report.details["overlap"][part].get<double>() << '\n';
  }
  text << "  axes: the camera's; standard uncertainties";
  return text.str();
}

Status Run(const HeadOptions& options, Context& context) {
  const auto neutral = Load(options.neutral, "neutral");
  if (!neutral) return Fail(neutral.error());
  const auto pose = Load(options.pose, "other");
  if (!pose) return Fail(pose.error());
  auto report = head::Measure(neutral->surface, pose->surface);
  if (!report) return Fail(report.error(), "measuring head against torso");
  for (const std::string& warning : Warnings(neutral->surface)) FlagAll(*report, "the neutral surface: " + warning);
  for (const std::string& warning : Warnings(pose->surface)) FlagAll(*report, "the surface: " + warning);
  report->provenance.inputs = {{"neutral surface", neutral->sha256}, {"pose surface", pose->sha256}};
  context.Output(ToJson(*report), Text(*report));
  return {};
}

}  // namespace

void AddCommand_measure_head(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "measure", "Measure on reconstructed surfaces");
  const auto options = std::make_shared<HeadOptions>();
  CLI::App* command =
      AddCommand(group, context, "head", "Rotation of the head against the torso between two captures of one person",
                 "striae measure head neutral.ply pose.ply --json");
  command->add_option("neutral", options->neutral, "Surface of the neutral pose (PLY)")->required();
  command->add_option("pose", options->pose, "Surface of the pose of interest (PLY)")->required();
  OnRun(command, context, [options](Context& c) { return Run(*options, c); });
}

}  // namespace striae::app
