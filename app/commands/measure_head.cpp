// striae measure head NEUTRAL POSE...: the head's rotation against the torso between captures of one person.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/head/absolute.h"
#include "analysis/head/angles.h"
#include "analysis/head/measure.h"
#include "app/command.h"
#include "app/head_pictures.h"
#include "app/head_series.h"
#include "app/io/files.h"
#include "core/ply.h"
#include "core/surface_comments.h"

namespace striae::app {
namespace {

struct HeadCommand {
  std::filesystem::path neutral, regions, pictures;
  std::vector<std::filesystem::path> poses;
  int repeats = 1;
  bool absolute = false;
};

/// What every pose of a call is measured with.
struct Neutral {
  Surface surface;
  Sha256 sha256;
  head::Options options;
  std::optional<Sha256> regions_sha256;
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

std::string Line(const Measurement& m) {
  char value[80];
  std::snprintf(value, sizeof value, "  %-12s%.1f +- %.1f deg   ", m.name.c_str(), m.value, m.uncertainty);
  return value + head::InWords(m.name, m.value);
}

/// Why numbers are flagged, each reason once.
std::string Doubts(const AnalysisReport& report) {
  std::string text;
  for (const Measurement& m : report.measurements) {
    if (m.status != Measurement::Status::kFlagged || text.find(m.reason) != std::string::npos) continue;
    text += "  FLAGGED: " + m.reason + '\n';
  }
  return text;
}

std::string Text(const AnalysisReport& report) {
  std::string text = "Head against torso, from the neutral to the other capture:\n";
  char line[160];
  for (const Measurement& m : report.measurements) {
    text += Line(m);
    if (const auto& bands = report.details["twstrs_bands"]; bands.contains(m.name)) {
      text += "   TWSTRS " + std::to_string(bands[m.name]["score"].get<int>()) + ": " +
              bands[m.name]["words"].get<std::string>();
    }
    if (m.status == Measurement::Status::kFlagged) text += "   flagged";
    text += '\n';
  }
  for (const char* part : {"head", "torso"}) {
    std::snprintf(line, sizeof line, "  %s (%s): %.2f mm left, overlap %.2f\n", part,
                  report.details["regions"][std::string(part) + "_source"].get<std::string>().c_str(),
                  report.details["residual_mm"][part].get<double>(), report.details["overlap"][part].get<double>());
    text += line;
  }
  return text + Doubts(report) + "  axes: the camera's; standard uncertainties";
}

Result<Neutral> LoadNeutral(const HeadCommand& command) {
  auto loaded = Load(command.neutral, "neutral");
  if (!loaded) return Fail(loaded.error());
  Neutral neutral{std::move(loaded->surface), loaded->sha256, {}, {}};
  if (command.regions.empty()) return neutral;
  const auto text = ReadText(command.regions);
  if (!text) return Fail(text.error(), "reading the regions");
  auto regions = head::RegionsFromJson(*text);
  if (!regions) return Fail(regions.error(), "reading the regions " + command.regions.string());
  const auto photograph = PhotographOf(neutral.surface);
  if (regions->image_sha256 && photograph && *regions->image_sha256 != *photograph) {
    return Fail(ErrorCode::kMeasurementRefused,
                "the regions " + command.regions.string() + " were drawn on another photograph (" +
                    regions->image_sha256->ToString().substr(0, 12) + "...) than the neutral surface was made from (" +
                    photograph->ToString().substr(0, 12) + "...): draw them on the neutral photograph");
  }
  neutral.options.regions = *std::move(regions);
  neutral.regions_sha256 = HashOf({reinterpret_cast<const std::uint8_t*>(text->data()), text->size()});
  return neutral;
}

Result<AnalysisReport> MeasurePose(const Neutral& neutral, const std::filesystem::path& path,
                                   const std::filesystem::path& pictures) {
  const auto pose = Load(path, "other");
  if (!pose) return Fail(pose.error());
  head::HeadFits fits;
  auto report = head::Measure(neutral.surface, pose->surface, neutral.options, &fits);
  if (!report) return Fail(report.error(), "measuring head against torso");
  for (const std::string& warning : Warnings(neutral.surface)) FlagAll(*report, "the neutral surface: " + warning);
  for (const std::string& warning : Warnings(pose->surface)) FlagAll(*report, "the surface: " + warning);
  report->provenance.inputs = {{"neutral surface", neutral.sha256}, {"pose surface", pose->sha256}};
  if (neutral.regions_sha256) report->provenance.inputs.push_back({"regions", *neutral.regions_sha256});
  if (!pictures.empty()) {
    const auto written = WriteHeadPictures(pictures, neutral.surface, pose->surface, fits, *report);
    if (!written) return Fail(written.error(), "drawing the head");
    report->details["pictures"] = *written;
  }
  return report;
}

Status RunAbsolute(const Neutral& capture, Context& context) {
  auto report = head::MeasureAbsolute(capture.surface, capture.options);
  if (!report) return Fail(report.error(), "measuring how the head stands on the torso");
  for (const std::string& warning : Warnings(capture.surface)) FlagAll(*report, "the surface: " + warning);
  report->provenance.inputs = {{"surface", capture.sha256}};
  if (capture.regions_sha256) report->provenance.inputs.push_back({"regions", *capture.regions_sha256});
  std::string text =
      "Head against torso in one capture, in anatomical axes (less certain than against a neutral one):\n";
  for (const Measurement& m : report->measurements) text += Line(m) + '\n';
  text += Doubts(*report) + "  landmarks " + report->details["landmarks_source"].get<std::string>() +
          "; standard uncertainties";
  context.Output(ToJson(*report), text);
  return {};
}

Status Run(const HeadCommand& command, Context& context) {
  if (command.absolute != command.poses.empty()) {
    return Fail(ErrorCode::kUsage, command.absolute ? "--absolute measures one capture: give no pose besides it"
                                                    : "give a pose to measure against the neutral one, or --absolute");
  }
  if (command.repeats < 1 || command.poses.size() % static_cast<std::size_t>(std::max(1, command.repeats)) != 0) {
    return Fail(ErrorCode::kUsage, "--repeats " + std::to_string(command.repeats) + " does not divide the " +
                                       std::to_string(command.poses.size()) + " poses");
  }
  const auto neutral = LoadNeutral(command);
  if (!neutral) return Fail(neutral.error());
  if (command.absolute) return RunAbsolute(*neutral, context);
  if (command.poses.size() == 1) {
    const auto report = MeasurePose(*neutral, command.poses.front(), command.pictures);
    if (!report) return Fail(report.error());
    context.Output(ToJson(*report), Text(*report));
    return {};
  }
  std::vector<HeadPose> poses;
  for (std::size_t k = 0; k < command.poses.size(); ++k) {
    const auto folder = command.pictures.empty() ? command.pictures : command.pictures / std::to_string(k + 1);
    poses.push_back({command.poses[k].string(), MeasurePose(*neutral, command.poses[k], folder)});
    if (!poses.back().report) context.Note(poses.back().name + ": " + poses.back().report.error().Describe());
  }
  const auto summary = SummariseHeads(poses, static_cast<std::size_t>(command.repeats));
  if (!summary) return Fail(summary.error());
  context.Output(summary->document, summary->text);
  return {};
}

}  // namespace

void AddCommand_measure_head(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "measure", "Measure on reconstructed surfaces");
  const auto options = std::make_shared<HeadCommand>();
  CLI::App* command =
      AddCommand(group, context, "head",
                 "Rotation of the head against the torso between two captures of one person, or in a series",
                 "striae measure head neutral.ply pose.ply --json\n  striae measure head neutral.ply left1.ply "
                 "left2.ply right1.ply "
                 "right2.ply --repeats 2");
  command->add_option("neutral", options->neutral, "Surface of the neutral pose (PLY)")->required();
  command->add_option("pose", options->poses,
                      "Surface of the pose of interest (PLY); several: their range of motion against the neutral pose");
  command->add_option("--regions", options->regions,
                      "Head or torso as drawn on the neutral photograph (JSON: head_px, torso_px), instead of found");
  command->add_option("--pictures", options->pictures,
                      "Folder for before.png, after.png, residuals.png (0 to 1 mm) and angles.png; of a series one "
                      "folder a pose in it");
  command->add_option("--repeats", options->repeats,
                      "So many captures in a row show one pose: gives the repeatability (SEM, MDC95)");
  command->add_flag("--absolute", options->absolute,
                    "One capture only: angles between the anatomical axes of head and torso (3 to 9 deg uncertain)");
  OnRun(command, context, [options](Context& c) { return Run(*options, c); });
}

}  // namespace striae::app
