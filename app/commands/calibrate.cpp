// `striae calibrate`: photographs of a reference object on a slide -> the rig's calibration.
#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "app/calibrating.h"
#include "app/command.h"
#include "app/io/files.h"

namespace striae::app {
namespace {

double Now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

Status WriteAll(Context& context, const CalibratingOptions& options, const Calibrating& work,
                const reconstruct::CalibrationFit& fit, double start) {
  if (!options.map.empty()) {
    const auto picture = DifferenceMap(work.panels);
    if (!picture) return Fail(picture.error());
    if (Status written = WriteFile(options.map, *picture); !written) return written;
  }
  if (Status written = WriteText(options.out, ToJsonText(fit.calibration)); !written) return written;
  const nlohmann::json report = ReportOf(work, fit, options, Now() - start);
  for (const auto& warning : report.at("warnings")) context.Note("warning: " + warning.get<std::string>());
  context.Output(report,
                 fmt::format("{}: sd {:.3f} mm (robust {:.3f} mm) over {} points of {} photographs, working distance "
                             "{:.0f} to {:.0f} mm",
                             options.out.string(), work.all.sd, work.all.robust_sd, work.all.count, work.shots.size(),
                             fit.calibration.near_mm, fit.calibration.far_mm));
  return {};
}

Status CalibrateWithObject(Context& context, CalibratingOptions options) {
  const double start = Now();
  const auto shape = ReadReference(options.reference);
  if (!shape) return Fail(shape.error());
  const auto steps = ReadSteps(options.steps);
  if (!steps) return Fail(steps.error());
  Calibrating work;
  std::vector<double> positions;
  for (const auto& step : *steps) positions.push_back(step.position_mm);
  // --distance-mm is that of the first line; the solver begins at the smallest position.
  work.nearest_position_mm = *std::min_element(positions.begin(), positions.end());
  work.nominal = NominalOf(options, options.distance_mm + work.nearest_position_mm - positions.front());
  if (Status slide = reconstruct::CheckSlide(positions, work.nominal.first_distance_mm); !slide) return slide;
  ProgressBar bar;
  if (Status measured = MeasureAll(*steps, options, *shape, bar, work); !measured) return measured;
  options.solve.progress = [&](double share, const std::string& what) {
    const auto photographs = static_cast<double>(steps->size());
    bar.Show(static_cast<std::size_t>((2 + share) * photographs), 5 * steps->size(), "solving: " + what);
  };
  auto fit = reconstruct::SolveCalibration(*shape, work.views, work.nominal, options.solve);
  if (!fit) return Fail(fit.error());
  const auto span = reconstruct::ObjectSpan(*fit, *shape, work.views);
  fit->calibration.near_mm = span.near_mm;
  fit->calibration.far_mm = span.far_mm;
  if (Status evaluated = Evaluate(*shape, *fit, bar, work); !evaluated) return evaluated;
  bar.Clear();
  std::vector<reconstruct::Spread> spreads;
  for (const Shot& shot : work.shots) spreads.push_back(shot.spread);
  const double middle_mm = (span.near_mm + span.far_mm) / 2;
  // The angular model is kept for comparison with the paper; that it fits badly is its result. The photographs have
  // been judged by the pinhole model before.
  const bool judged = options.solve.model == ProjectorModel::Kind::kPinhole;
  if (Status fair = reconstruct::JudgeSpread(work.all, spreads, middle_mm); judged && !fair) return fair;

  Calibration& calibration = fit->calibration;
  calibration.quality = Calibration::Quality{work.all.sd, static_cast<int>(work.shots.size())};
  for (std::size_t i = 0; i < work.shots.size(); ++i) {
    calibration.sources.push_back({work.shots[i].sha256, work.views[i].position_mm});
  }
  return WriteAll(context, options, work, *fit, start);
}

Status CalibrateWithPrintedBoard(Context& context, const CalibratingOptions& options) {
  const double start = Now();
  auto found = CalibrateWithBoard(options);
  if (!found) return Fail(found.error());
  if (Status written = WriteText(options.out, ToJsonText(found->fit.calibration)); !written) return written;
  found->report["seconds"] = {{"total", Now() - start}};
  for (const auto& warning : found->report.at("warnings")) context.Note("warning: " + warning.get<std::string>());
  context.Output(found->report, fmt::format("{}: sd {:.3f} mm (robust {:.3f} mm), corners {:.2f} px, {} photographs",
                                            options.out.string(), found->fit.sd_mm, found->fit.robust_sd_mm,
                                            found->fit.corner_rms_px, options.board.size()));
  return {};
}

Status CalibrateEitherWay(Context& context, const CalibratingOptions& options) {
  if (!options.board.empty()) return CalibrateWithPrintedBoard(context, options);
  if (options.reference.empty() || options.steps.empty()) {
    return Fail(ErrorCode::kUsage, "give --reference and --steps, or the photographs of the printed board (--board)");
  }
  return CalibrateWithObject(context, options);
}

}  // namespace

void AddCommand_calibrate(CLI::App& root, Context& context) {
  CLI::App* command = AddCommand(root, context, "calibrate",
                                 "Find the rig's parameters from photographs of a reference object on a slide",
                                 "striae calibrate --reference ref.ply --steps steps.csv --stripes 140 --period-um 48 "
                                 "--distance-mm 900 --out small.json --map differences.png");
  auto options = std::make_shared<CalibratingOptions>();
  command->add_option("--reference", options->reference, "Mesh of the object (PLY, mm; relief along -z)");
  auto* steps =
      command->add_option("--steps", options->steps, "CSV image,position_mm; positions grow away from the camera");
  command->add_option("--board", options->board, "Photographs of the board of `striae print board`, about twelve")
      ->excludes(steps);
  command->add_option("--range", options->range, "Which board was printed: small (A4) or large (A3)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, RigRange>{{"small", RigRange::kSmall}, {"large", RigRange::kLarge}}))
      ->default_str("small");
  command->add_option("--stripes", options->stripes, "Number of stripes of the grating")
      ->required()
      ->check(CLI::Range(4, 9999));
  command->add_option("--period-um", options->period_um, "Period of the grating, micrometres")
      ->required()
      ->check(CLI::Range(1.0, 10000.0));
  command
      ->add_option("--distance-mm", options->distance_mm,
                   "Rough distance of the object (of the board) in the first photograph")
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
  using Kind = ProjectorModel::Kind;
  using reconstruct::Optimizer;
  command->add_option("--model", options->solve.model, "pinhole, or the paper's angular model for comparison")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Kind>{{"pinhole", Kind::kPinhole}, {"angular", Kind::kAngular}}))
      ->default_str("pinhole");
  command->add_option("--optimizer", options->solve.optimizer, "lm, or the paper's powell for comparison (slower)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Optimizer>{{"lm", Optimizer::kLevenbergMarquardt}, {"powell", Optimizer::kPowell}}))
      ->default_str("lm");
  OnRun(command, context, [options](Context& run) { return CalibrateEitherWay(run, *options); });
}

}  // namespace striae::app
