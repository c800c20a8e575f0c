#include "app/calibrating.h"

namespace striae::app {

nlohmann::json ReportOf(const Calibrating& work, const reconstruct::CalibrationFit& fit,
                        const CalibratingOptions& options, double seconds) {
  const bool pinhole = options.solve.model == ProjectorModel::Kind::kPinhole;
  const bool powell = options.solve.optimizer == reconstruct::Optimizer::kPowell;
  nlohmann::json document = {{"out", options.out.string()},
                             {"sd_mm", work.all.sd},
                             {"robust_sd_mm", work.all.robust_sd},
                             {"mean_mm", work.all.mean},
                             {"points", work.all.count},
                             {"coverage", work.coverage},
                             {"sd_stripes", fit.sd_stripes},
                             {"order_is_absolute", fit.order_is_absolute},
                             {"working_distance_mm", {fit.calibration.near_mm, fit.calibration.far_mm}},
                             {"model", pinhole ? "pinhole" : "angular"},
                             {"optimizer", powell ? "powell" : "lm"},
                             {"photographs", nlohmann::json::array()},
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
                                       {"modulation", shot.modulation},
                                       {"carrier_period_px", shot.carrier_period_px}});
  }
  AddParameters(fit.parameters, fit.correlations, fit.order_is_absolute, document);
  return document;
}

void AddParameters(const std::vector<reconstruct::CalibrationFit::Parameter>& parameters,
                   const std::vector<reconstruct::CalibrationFit::Correlation>& correlations, bool order_is_absolute,
                   nlohmann::json& document) {
  document["parameters"] = nlohmann::json::object();
  document["correlations"] = nlohmann::json::array();
  document["warnings"] = nlohmann::json::array();
  for (const auto& parameter : parameters) {
    document["parameters"][parameter.name] = {{"value", parameter.value}, {"uncertainty", parameter.uncertainty}};
  }
  for (const auto& pair : correlations) {
    document["correlations"].push_back({{"parameters", {pair.first, pair.second}}, {"value", pair.value}});
  }
  if (!correlations.empty()) {
    document["warnings"].push_back(
        "the photographs hardly tell some parameters apart (see correlations): only together are they known, and only "
        "within the working distance");
  }
  if (!order_is_absolute) {
    document["warnings"].push_back(
        "no photograph shows an end of the grating, so the calibration is written without its number of stripes; the "
        "whole stripe then rests on the subject's distance alone");
  }
}

}  // namespace striae::app
