#include "analysis/wound/detail/report.h"

namespace striae::wound {
namespace {

Code Sct(const char* value, const char* meaning) { return {"SCT", value, meaning}; }
Code Loinc(const char* value, const char* meaning) { return {"LN", value, meaning}; }
Code Local(const char* value, const char* meaning) { return {"99STRIAE", value, meaning}; }

struct Quantity {
  const char* name;
  Code code;
  std::vector<Code> equivalents;
  const char* unit;
  double factor;  // from mm, mm2, mm3
  Figure Figures::*figure;
  enum class Needs { kBoundary, kInside, kVolume } needs;
};

const std::vector<Quantity>& Quantities() {
  using enum Quantity::Needs;
  // Published codes where one means exactly this quantity; the local scheme 99STRIAE otherwise (docs/wound.md).
  static const std::vector<Quantity> kQuantities = {
      {"volume", Sct("118565006", "Volume"), {Loinc("94083-3", "Wound volume")}, "mL", 1e-3, &Figures::volume, kVolume},
      {"proud_volume",
       Local("PROUD_VOLUME", "Volume of tissue above the virtual skin"),
       {},
       "mL",
       1e-3,
       &Figures::proud_volume,
       kInside},
      {"area", Sct("42798000", "Area"), {Loinc("89260-4", "Wound area")}, "cm2", 1e-2, &Figures::area, kBoundary},
      {"bed_area", Local("BED_AREA", "Area of the measured wound bed"), {}, "cm2", 1e-2, &Figures::bed_area, kInside},
      {"perimeter", Sct("131191004", "Perimeter"), {}, "mm", 1, &Figures::perimeter, kBoundary},
      {"depth_max",
       Sct("131197000", "Depth"),
       {Loinc("39127-6", "Wound depth")},
       "mm",
       1,
       &Figures::depth_max,
       kInside},
      {"depth_p95", Local("DEPTH_P95", "95th percentile of wound depth"), {}, "mm", 1, &Figures::depth_p95, kInside},
      {"depth_mean", Local("DEPTH_MEAN", "Mean wound depth"), {}, "mm", 1, &Figures::depth_mean, kVolume},
      {"length", Sct("410668003", "Length"), {Loinc("39126-8", "Wound length")}, "mm", 1, &Figures::length, kBoundary},
      {"width",
       Local("WIDTH", "Wound width across its length"),
       {Loinc("39125-0", "Wound width")},
       "mm",
       1,
       &Figures::width,
       kBoundary},
  };
  return kQuantities;
}

void Append(std::string& reason, const std::vector<std::string>& more) {
  for (const auto& text : more) reason += (reason.empty() ? "" : "; ") + text;
}

}  // namespace

std::vector<Measurement> CodedMeasurements(const Figures& figures, const Flags& flags) {
  std::vector<Measurement> measurements;
  for (const Quantity& quantity : Quantities()) {
    Measurement m;
    m.name = quantity.name;
    m.code = quantity.code;
    m.equivalents = quantity.equivalents;
    m.unit = quantity.unit;
    m.value = (figures.*quantity.figure).value * quantity.factor;
    m.uncertainty = (figures.*quantity.figure).uncertainty * quantity.factor;
    Append(m.reason, flags.all);
    if (quantity.needs != Quantity::Needs::kBoundary) Append(m.reason, flags.inside);
    if (quantity.needs == Quantity::Needs::kVolume) Append(m.reason, flags.volume);
    if (!m.reason.empty()) m.status = Measurement::Status::kFlagged;
    measurements.push_back(std::move(m));
  }
  return measurements;
}

nlohmann::json ToJson(const Options& options) {
  return {{"cell_mm", options.cell_mm},
          {"margin_mm", options.margin_mm},
          {"gaps_mm", options.gaps_mm},
          {"ring_width_mm", options.ring_width_mm},
          {"radial_trend_mm", options.radial_trend_mm},
          {"null_cell_mm", options.null_cell_mm},
          {"smoothing_mm", options.smoothing_mm},
          {"deepest_mm", options.deepest_mm},
          {"resolution_mm", options.resolution_mm},
          {"perimeter_step_mm", options.perimeter_step_mm},
          {"max_ring_slope_deg", options.max_ring_slope_deg},
          {"outline_sd_mm", options.outline_sd_mm},
          {"wall_sd_mm", options.wall_sd_mm},
          {"rim_share", options.rim_share},
          {"bridge_mm", options.bridge_mm},
          {"scale_relative_sd", options.scale_relative_sd}};
}

}  // namespace striae::wound
