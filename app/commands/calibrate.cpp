// `striae calibrate`: photographs of a reference object on a slide -> the rig's calibration.
#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "acquire/metadata.h"
#include "app/command.h"
#include "app/io/difference_map.h"
#include "app/io/files.h"
#include "app/io/photograph.h"
#include "app/progress.h"
#include "core/ply.h"
#include "reconstruct/calibrate/photographs.h"
#include "reconstruct/calibrate/steps.h"
#include "reconstruct/reconstruct.h"

namespace striae::app {
namespace {

namespace fs = std::filesystem;
using reconstruct::Spread;

struct Options {
  fs::path reference, steps, out, map;
  int stripes = 0;
  double period_um = 0, distance_mm = 0;
  double sensor_width_mm = 23.6;   ///< the D90's
  double projector_focal_mm = 25;  ///< the C-mount lens
};

double Now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

struct Opened {
  Photograph photograph;
  Sha256 sha256;
  std::optional<double> focal_length_mm;  ///< EXIF
};

Result<Opened> Open(const fs::path& path) {
  const auto bytes = ReadFile(path);
  if (!bytes) return Fail(bytes.error());
  auto photograph = DecodePhotograph(*bytes);
  if (!photograph) return Fail(photograph.error(), path.string());
  Opened opened{std::move(*photograph), HashOf(*bytes), {}};
  if (const auto metadata = acquire::ReadMetadata(*bytes)) opened.focal_length_mm = metadata->focal_length_mm;
  return opened;
}

/// One photograph before and after the solution.
struct Shot {
  std::string image;
  fs::path path;
  Sha256 sha256;
  double carrier_period_px = 0;
  Spread spread;
  double coverage = 0;
  reconstruct::OrderSource order_source = reconstruct::OrderSource::kNone;
  double order_margin = 0;
};

/// Everything between reading and writing.
struct Work {
  std::vector<Shot> shots;
  std::vector<reconstruct::CalibrationView> views;
  reconstruct::NominalRig nominal;
  std::vector<DifferencePanel> panels;
  Spread all;
  double coverage = 0;
};

Result<reconstruct::ReferenceShape> ReadReference(const fs::path& path) {
  const auto bytes = ReadFile(path);
  if (!bytes) return Fail(bytes.error());
  const auto mesh = DecodePly(*bytes);
  if (!mesh) return Fail(mesh.error(), path.string());
  auto shape = reconstruct::ReferenceShape::FromMesh(*mesh);
  if (!shape) return Fail(shape.error(), path.string());
  return shape;
}

Result<std::vector<reconstruct::CalibrationStep>> ReadSteps(const fs::path& path) {
  const auto text = ReadText(path);
  if (!text) return Fail(text.error());
  auto steps = reconstruct::ParseSteps(*text);
  if (!steps) return Fail(steps.error(), path.string());
  return steps;
}

reconstruct::NominalRig Nominal(const Options& options, const std::vector<reconstruct::CalibrationStep>& steps) {
  reconstruct::NominalRig nominal;
  nominal.projector_focal_mm = options.projector_focal_mm;
  nominal.grating_period_mm = options.period_um / 1000;
  nominal.stripes = options.stripes;
  // --distance-mm is that of the first line; the solver begins at the smallest position.
  const auto nearest = std::min_element(steps.begin(), steps.end(),
                                        [](const auto& a, const auto& b) { return a.position_mm < b.position_mm; });
  nominal.first_distance_mm = options.distance_mm + nearest->position_mm - steps.front().position_mm;
  return nominal;
}

/// The first photograph says what the camera is; the others must be of its size.
Status AdoptCamera(const Opened& opened, bool first, const Options& options, reconstruct::NominalRig& nominal) {
  const int width = opened.photograph.luminance.width(), height = opened.photograph.luminance.height();
  if (first) {
    nominal.image_width_px = width;
    nominal.image_height_px = height;
    nominal.pixel_pitch_mm = options.sensor_width_mm / std::max(width, height);
    nominal.camera_focal_mm = opened.focal_length_mm.value_or(nominal.camera_focal_mm);
    return {};
  }
  if (width == nominal.image_width_px && height == nominal.image_height_px) return {};
  return Fail(ErrorCode::kBadCalibration,
              fmt::format("the photograph has {} x {} pixels, the first one {} x {}; all must come from one camera at "
                          "full size",
                          width, height, nominal.image_width_px, nominal.image_height_px));
}

Status MeasureAll(const std::vector<reconstruct::CalibrationStep>& steps, const Options& options, ProgressBar& bar,
                  Work& work) {
  for (const auto& step : steps) {
    bar.Show(work.shots.size(), 2 * steps.size(), "phase of " + step.image);
    Shot shot;
    shot.image = step.image;
    shot.path = options.steps.parent_path() / step.image;
    const auto opened = Open(shot.path);
    if (!opened) return Fail(opened.error());
    shot.sha256 = opened->sha256;
    const bool first = work.shots.empty();
    if (Status same = AdoptCamera(*opened, first, options, work.nominal); !same) {
      return Fail(same.error(), shot.path.string());
    }
    const auto phase = reconstruct::MeasurePhase(opened->photograph);
    if (!phase) return Fail(phase.error(), shot.path.string());
    shot.carrier_period_px = phase->carrier_period_px;
    if (first) work.nominal.direction = phase->direction;
    if (phase->direction != work.nominal.direction) {
      return Fail(ErrorCode::kBadCalibration,
                  shot.path.string() + ": the stripes run across those of the first photograph");
    }
    work.views.push_back(reconstruct::ViewFromPhase(*phase, step.position_mm));
    work.shots.push_back(std::move(shot));
  }
  return {};
}

/// Reconstructs every photograph with the calibration found and compares it with the posed reference.
Status Evaluate(const reconstruct::ReferenceShape& shape, const reconstruct::CalibrationFit& fit, ProgressBar& bar,
                Work& work) {
  std::vector<float> all;
  double lit = 0;
  for (std::size_t i = 0; i < work.shots.size(); ++i) {
    Shot& shot = work.shots[i];
    bar.Show(work.shots.size() + i, 2 * work.shots.size(), "surface of " + shot.image);
    const auto opened = Open(shot.path);
    if (!opened) return Fail(opened.error());
    reconstruct::ReconstructOptions settings;
    settings.faces = false;
    const auto surface = reconstruct::Reconstruct(opened->photograph, fit.calibration, settings);
    if (!surface) return Fail(surface.error(), shot.path.string());
    auto found = reconstruct::CompareWithReference(surface->surface, fit, shape, work.views[i].position_mm);
    shot.order_source = surface->regions.front().source;
    shot.order_margin = surface->regions.front().margin;
    const double field = static_cast<double>(surface->surface.size()) / std::max(1e-9, surface->coverage);
    shot.coverage = static_cast<double>(found.values_mm.size()) / field;
    lit += field;
    all.insert(all.end(), found.values_mm.begin(), found.values_mm.end());
    work.panels.push_back({fmt::format("{}  {:g} mm", shot.image, work.views[i].position_mm), std::move(found.map_mm)});
    shot.spread = reconstruct::SpreadOf(std::move(found.values_mm));
  }
  work.coverage = static_cast<double>(all.size()) / lit;
  work.all = reconstruct::SpreadOf(std::move(all));
  return {};
}

nlohmann::json ToJson(const Work& work, const reconstruct::CalibrationFit& fit, const fs::path& out, double seconds) {
  nlohmann::json document = {{"out", out.string()},
                             {"sd_mm", work.all.sd},
                             {"robust_sd_mm", work.all.robust_sd},
                             {"mean_mm", work.all.mean},
                             {"points", work.all.count},
                             {"coverage", work.coverage},
                             {"sd_stripes", fit.sd_stripes},
                             {"order_is_absolute", fit.order_is_absolute},
                             {"working_distance_mm", {fit.calibration.near_mm, fit.calibration.far_mm}},
                             {"photographs", nlohmann::json::array()},
                             {"parameters", nlohmann::json::object()},
                             {"seconds", {{"total", seconds}}}};
  for (std::size_t i = 0; i < work.shots.size(); ++i) {
    const Shot& shot = work.shots[i];
    document["photographs"].push_back({{"image", shot.image},
                                       {"sha256", shot.sha256.ToString()},
                                       {"position_mm", work.views[i].position_mm},
                                       {"sd_mm", shot.spread.sd},
                                       {"robust_sd_mm", shot.spread.robust_sd},
                                       {"mean_mm", shot.spread.mean},
                                       {"median_mm", shot.spread.median},
                                       {"points", shot.spread.count},
                                       {"coverage", shot.coverage},
                                       {"order", fit.views[i].whole_stripes},
                                       {"order_source", ToString(shot.order_source)},
                                       {"order_margin", shot.order_margin},
                                       {"offset", fit.views[i].offset_before_rounding},
                                       {"sd_stripes", fit.views[i].sd_stripes},
                                       {"samples", fit.views[i].samples},
                                       {"carrier_period_px", shot.carrier_period_px}});
  }
  for (const auto& parameter : fit.parameters) {
    document["parameters"][parameter.name] = {{"value", parameter.value}, {"uncertainty", parameter.uncertainty}};
  }
  return document;
}

Status Calibrate(Context& context, const Options& options) {
  const double start = Now();
  const auto shape = ReadReference(options.reference);
  if (!shape) return Fail(shape.error());
  const auto steps = ReadSteps(options.steps);
  if (!steps) return Fail(steps.error());
  Work work;
  work.nominal = Nominal(options, *steps);
  std::vector<double> positions;
  for (const auto& step : *steps) positions.push_back(step.position_mm);
  if (Status slide = reconstruct::CheckSlide(positions, work.nominal.first_distance_mm); !slide) return slide;
  ProgressBar bar;
  if (Status measured = MeasureAll(*steps, options, bar, work); !measured) return measured;
  bar.Show(steps->size(), 2 * steps->size(), "solving");
  auto fit = reconstruct::SolveCalibration(*shape, work.views, work.nominal);
  if (!fit) return Fail(fit.error());
  const auto span = reconstruct::ObjectSpan(*fit, *shape, work.views);
  fit->calibration.near_mm = span.near_mm;
  fit->calibration.far_mm = span.far_mm;
  if (Status evaluated = Evaluate(*shape, *fit, bar, work); !evaluated) return evaluated;
  bar.Clear();
  std::vector<Spread> spreads;
  for (const Shot& shot : work.shots) spreads.push_back(shot.spread);
  Status fair = reconstruct::JudgeSpread(work.all, spreads, (span.near_mm + span.far_mm) / 2);
  if (!fair) return fair;

  Calibration& calibration = fit->calibration;
  calibration.quality = Calibration::Quality{work.all.sd, static_cast<int>(work.shots.size())};
  for (std::size_t i = 0; i < work.shots.size(); ++i) {
    calibration.sources.push_back({work.shots[i].sha256, work.views[i].position_mm});
  }
  if (!options.map.empty()) {
    const auto picture = DifferenceMap(work.panels);
    if (!picture) return Fail(picture.error());
    if (Status written = WriteFile(options.map, *picture); !written) return written;
  }
  if (Status written = WriteText(options.out, ToJsonText(calibration)); !written) return written;
  if (!fit->order_is_absolute) {
    context.Note(
        "warning: no photograph shows an end of the grating, so the calibration is written without its number "
        "of stripes; the whole stripe then rests on the subject's distance alone");
  }
  context.Output(ToJson(work, *fit, options.out, Now() - start),
                 fmt::format("{}: sd {:.3f} mm (robust {:.3f} mm) over {} points of {} photographs, working distance "
                             "{:.0f} to {:.0f} mm",
                             options.out.string(), work.all.sd, work.all.robust_sd, work.all.count, work.shots.size(),
                             span.near_mm, span.far_mm));
  return {};
}

}  // namespace

void AddCommand_calibrate(CLI::App& root, Context& context) {
  CLI::App* command = AddCommand(root, context, "calibrate",
                                 "Find the rig's parameters from photographs of a reference object on a slide",
                                 "striae calibrate --reference ref.ply --steps steps.csv --stripes 140 --period-um 48 "
                                 "--distance-mm 900 --out small.json --map differences.png");
  auto options = std::make_shared<Options>();
  command->add_option("--reference", options->reference, "Mesh of the object (PLY, mm; relief along -z)")->required();
  command->add_option("--steps", options->steps, "CSV image,position_mm; positions grow away from the camera")
      ->required();
  command->add_option("--stripes", options->stripes, "Number of stripes of the grating")
      ->required()
      ->check(CLI::Range(4, 9999));
  command->add_option("--period-um", options->period_um, "Period of the grating, micrometres")
      ->required()
      ->check(CLI::Range(1.0, 10000.0));
  command->add_option("--distance-mm", options->distance_mm, "Rough distance of the object in the first photograph")
      ->required()
      ->check(CLI::Range(50.0, 100000.0));
  command->add_option("--out", options->out, "Calibration to write (JSON)")->required();
  command->add_option("--map", options->map, "Picture of the differences to write (PNG)");
  command->add_option("--sensor-width-mm", options->sensor_width_mm, "Longer side of the camera's sensor")
      ->check(CLI::Range(1.0, 100.0))
      ->capture_default_str();
  command->add_option("--projector-focal-mm", options->projector_focal_mm, "Focal length of the projector's lens")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  OnRun(command, context, [options](Context& run) { return Calibrate(run, *options); });
}

}  // namespace striae::app
