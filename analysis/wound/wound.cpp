#include "analysis/wound/wound.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/wound/detail/budget.h"
#include "analysis/wound/detail/choice.h"
#include "analysis/wound/detail/deepest.h"
#include "analysis/wound/detail/maps.h"
#include "analysis/wound/detail/quantities.h"
#include "analysis/wound/detail/report.h"
#include "analysis/wound/detail/scene.h"
#include "analysis/wound/detail/surface_noise.h"
#include "analysis/wound/detail/swelling.h"
#include "core/surface_comments.h"

namespace striae::wound {
namespace {

constexpr double kProudNoise = 3;  // tissue above the skin counts from this many sd of the smoothed ring

Status CheckOptions(const Options& o) {
  const bool positive = o.cell_mm > 0 && o.margin_mm >= 0 && o.ring_width_mm > 0 && o.smoothing_mm >= 0 &&
                        o.perimeter_step_mm > 0 && o.max_ring_slope_deg > 0 && o.max_ring_slope_deg < 90 &&
                        o.outline_sd_mm >= 0 && o.scale_relative_sd >= 0 && o.wall_sd_mm >= 0 && o.rim_share >= 0 &&
                        o.bridge_mm >= 0 && o.radial_trend_mm > 0;
  const bool gaps =
      !o.gaps_mm.empty() && o.gaps_mm.front() >= o.margin_mm && std::is_sorted(o.gaps_mm.begin(), o.gaps_mm.end());
  if (positive && gaps) return {};
  return Fail(ErrorCode::kUsage,
              "wound options: lengths must be positive, and the gaps ascending and not smaller than the margin");
}

// Null wounds and swelling need skin further out than a wound's own ring.
double WideReach(const Scene& scene, const Options& options) {
  double across_mm = 0;
  for (const auto& p : scene.outline) across_mm = std::max(across_mm, 2 * (p - scene.outline.front()).norm());
  return std::max(45.0, across_mm + 2 * options.gaps_mm.front() + options.ring_width_mm + 6);
}

// The Fourier stage's window is flat at its top; what rounds is the background's removal, a mean over T twice: beside
// f T = 1, 1 - sinc^2 falls by (f T - 1)^2.
constexpr double kStripesPerResolution = std::numbers::sqrt2 * std::numbers::pi;

// Distance of the stripes on the skin: of so many pixels each.
double StripeOf(const Surface& surface, double pixel_mm, const Options& options) {
  const auto period_px = CarrierPeriodOf(surface);
  return period_px ? *period_px * pixel_mm : options.resolution_mm * kStripesPerResolution;
}

// Sd of the smoothing that frees a line of its shakes: four times its roughness, and not less than its points' spacing,
// but nothing for a line without shakes.
double LineSmoothing(const Scene& scene, const LineStudy& line, std::size_t points) {
  const double spacing = PolygonField(scene.outline).perimeter() / static_cast<double>(points);
  return std::max(4 * line.roughness, std::min(spacing, 8 * line.roughness));
}

nlohmann::json NullsAsJson(const IntactSkin& intact, std::size_t model) {
  nlohmann::json nulls = nlohmann::json::array();
  for (const NullWound& null : intact.wounds) {
    if (null.mean_mm[model])
      nulls.push_back({{"shift_mm", {null.shift_mm.x(), null.shift_mm.y()}}, {"mean_mm", *null.mean_mm[model]}});
  }
  return nulls;
}

}  // namespace

std::string_view MethodVersion() { return "wound/5"; }

Result<AnalysisReport> Measure(const Surface& surface, const Outline& outline, const Options& options,
                               WoundMaps* maps) {
  if (auto good = CheckOptions(options); !good) return Fail(good.error());
  auto plus = BuildScene(surface, outline, options);
  if (!plus) return Fail(plus.error());
  const Scene& scene = plus->scene;

  const Bed bed = TakeBed(scene, options.margin_mm);
  const auto coarse =
      CoarseScene(surface, outline, scene, std::max(options.null_cell_mm, options.cell_mm), WideReach(scene, options));
  if (!coarse) return Fail(coarse.error());
  auto choice = ChooseRing(scene, *coarse, bed, options);
  if (!choice) return Fail(choice.error());
  const IntactSkin intact =
      TryIntactSkin(*coarse, choice->chosen.ring.gap_mm, choice->chosen.ring.width_mm, options.max_ring_slope_deg);
  const ModelChoice model = ChooseModel(choice->chosen, intact);
  Attempt& a = choice->chosen;
  if (model.model != 0) a.skin = FitSkin(kSkinModels[model.model], a.ring.points, a.weights);
  Flags flags;
  if (auto good = CheckRing(*choice, options, flags); !good) return Fail(good.error());
  if (plus->boundary_share < 0.97) flags.all.push_back("part of the outline lies at an edge or hole of the surface");
  if (plus->hole_share > 0.02) {
    flags.inside.push_back(
        Format("%.0f %% of the surface inside the outline was missing and bridged", 100 * plus->hole_share));
  }

  Findings findings;
  const auto net = VolumeBetween(MakeSheets(bed, a.skin));
  if (!net) return Fail(net.error(), "measuring the wound's volume");
  findings.net_mm3 = *net;
  const auto smoothed = SmoothedHeights(scene, a.skin, options.smoothing_mm, a.ring.gap_mm + a.ring.width_mm);
  findings.noise_mm = SmoothedRingSd(scene, smoothed, a.ring);
  findings.depths = MeasureDepths(scene, bed, a.skin, smoothed, kProudNoise * findings.noise_mm);
  findings.stripe_mm = StripeOf(surface, scene.patch.pixel_mm, options);
  findings.resolution_mm = findings.stripe_mm / kStripesPerResolution;
  findings.skin_uncertainty_mm = SkinUncertainty(scene, a.ring);
  findings.deepest = FindDeepest(scene, bed, a.skin, findings.depths, options.deepest_mm, findings.resolution_mm,
                                 findings.skin_uncertainty_mm);
  findings.boundary = MeasureBoundary(scene.outline, a.skin, options.perimeter_step_mm, scene.patch.cell_mm(),
                                      LineSmoothing(scene, plus->line, outline.polygon_px.size()));
  findings.line = plus->line;
  const Budget budget = DrawBudget(scene, bed, *choice, model, intact, findings, options, flags);

  if (maps != nullptr) *maps = DrawMaps(scene, a.skin, findings.boundary, options.gaps_mm.front() + 4, 6);

  AnalysisReport report;
  report.analysis = "wound";
  report.version = MethodVersion();
  report.provenance.version = StriaeVersion();
  report.provenance.parameters = ToJson(options);
  report.measurements = CodedMeasurements(budget.figures, flags);
  report.details["skin"] = {{"model", std::string(ToString(a.skin.model))},
                            {"gap_mm", a.ring.gap_mm},
                            {"ring_width_mm", a.ring.width_mm},
                            {"ring_points", a.ring.points.size()},
                            {"ring_coverage", a.ring.coverage},
                            {"ring_rms_mm", a.skin.rms_mm},
                            {"radial_step_mm", a.trend.step_mm},
                            {"chosen_by", model.by},
                            {"null_wounds", NullsAsJson(intact, model.model)},
                            {"models", budget.models}};
  if (choice->swelling.looked) {
    report.details["swelling"] = {{"found", choice->swelling.ends_mm > 0},
                                  {"height_mm", choice->swelling.height_mm},
                                  {"ends_mm", choice->swelling.ends_mm},
                                  {"profile_mm", choice->swelling.profile_mm}};
  }
  report.details["net_volume_ml"] = *net / 1000;
  report.details["net_volume_at_first_gap_ml"] = choice->first_volume_mm3 / 1000;
  report.details["volume_uncertainty_parts_ml"] = budget.volume_parts_ml;
  report.details["depth_max_uncertainty_parts_mm"] = budget.depth_parts_mm;
  report.details["depth_max"] = {{"at_px", {findings.deepest.at_px.x(), findings.deepest.at_px.y()}},
                                 {"smoothed_mm", findings.depths.max_mm},
                                 {"window_correction_mm", findings.deepest.correction_mm},
                                 {"fit_noise_mm", findings.deepest.noise_mm}};
  report.details["outline_roughness_mm"] = plus->line.roughness;
  report.details["hole_share"] = plus->hole_share;
  report.details["resolution_mm"] = findings.resolution_mm;
  report.details["cell_mm"] = scene.patch.cell_mm();
  report.details["length_axis"] = "longest";
  return report;
}

}  // namespace striae::wound
