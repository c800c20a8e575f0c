#include <fmt/format.h>

#include "app/calibrating.h"
#include "core/target.h"

namespace striae::app {
namespace {

nlohmann::json ReportOf(const reconstruct::BoardFit& fit, const CalibratingOptions& options,
                        const std::vector<Shot>& shots) {
  nlohmann::json document = {{"out", options.out.string()},
                             {"sd_mm", fit.sd_mm},
                             {"robust_sd_mm", fit.robust_sd_mm},
                             {"corner_rms_px", fit.corner_rms_px},
                             {"order_is_absolute", fit.order_is_absolute},
                             {"working_distance_mm", {fit.calibration.near_mm, fit.calibration.far_mm}},
                             {"model", "pinhole"},
                             {"photographs", nlohmann::json::array()}};
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const reconstruct::BoardViewFit& view = fit.views[i];
    document["photographs"].push_back({{"image", shots[i].image},
                                       {"sha256", shots[i].sha256.ToString()},
                                       {"sd_mm", view.sd_mm},
                                       {"sd_stripes", view.sd_stripes},
                                       {"order", view.whole_stripes},
                                       {"offset", view.offset_before_rounding},
                                       {"corners", view.corners},
                                       {"corner_rms_px", view.corner_rms_px},
                                       {"samples", view.samples},
                                       {"distance_mm", view.distance_mm},
                                       {"tilt_deg", view.tilt_deg}});
  }
  AddParameters(fit.parameters, fit.correlations, fit.order_is_absolute, document);
  return document;
}

}  // namespace

Result<BoardCalibrated> CalibrateWithBoard(const CalibratingOptions& options) {
  const CharucoBoard board = BoardFor(options.range);
  reconstruct::NominalRig nominal = NominalOf(options, options.distance_mm);
  std::vector<reconstruct::BoardView> views;
  std::vector<Shot> shots;
  ProgressBar bar;
  for (const auto& path : options.board) {
    bar.Show(shots.size(), options.board.size() + 2, "board on " + path.filename().string());
    const auto opened = OpenForCalibration(path);
    if (!opened) return Fail(opened.error());
    if (Status same = AdoptCamera(*opened, shots.empty(), options, nominal); !same) {
      return Fail(same.error(), path.string());
    }
    const auto phase = reconstruct::MeasurePhase(opened->photograph);
    if (!phase) return Fail(phase.error(), path.string());
    if (shots.empty()) nominal.direction = phase->direction;
    if (phase->direction != nominal.direction) {
      return Fail(ErrorCode::kBadCalibration, path.string() + ": the stripes run across those of the first photograph");
    }
    auto view = reconstruct::ViewOfBoard(*phase, board);
    if (!view) return Fail(view.error(), path.string());
    views.push_back(std::move(*view));
    Shot shot;
    shot.image = path.filename().string();
    shot.path = path;
    shot.sha256 = opened->sha256;
    shots.push_back(std::move(shot));
  }
  bar.Show(shots.size(), options.board.size() + 2, "solving");
  auto fit = reconstruct::SolveWithBoard(views, board, nominal);
  bar.Clear();
  if (!fit) return Fail(fit.error());
  nlohmann::json report = ReportOf(*fit, options, shots);
  return BoardCalibrated{std::move(*fit), std::move(report)};
}

}  // namespace striae::app
