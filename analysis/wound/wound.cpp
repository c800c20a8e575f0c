#include "analysis/wound/wound.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "analysis/wound/detail/quantities.h"
#include "analysis/wound/detail/report.h"
#include "analysis/wound/detail/scene.h"
#include "analysis/wound/detail/uncertainty.h"

namespace striae::wound {
namespace {

constexpr double kLeastCoverage = 0.6, kGoodCoverage = 0.9;
constexpr double kMostEmptySectors = 0.25;
constexpr double kMostSteep = 0.1, kMostOutliers = 0.3, kManyOutliers = 0.1;
constexpr double kComparableFit = 1.2;  // a model whose ring rms is worse than this does not fit, and says nothing
constexpr double kTrendT = 3;

std::string Format(const char* format, double value) {
  char text[200];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

Status CheckOptions(const Options& o) {
  const bool positive = o.cell_mm > 0 && o.margin_mm >= 0 && o.ring_width_mm > 0 && o.smoothing_mm >= 0 &&
                        o.perimeter_step_mm > 0 && o.max_ring_slope_deg > 0 && o.max_ring_slope_deg < 90 &&
                        o.outline_sd_mm >= 0 && o.scale_relative_sd >= 0 && o.radial_trend_mm > 0;
  const bool gaps =
      !o.gaps_mm.empty() && o.gaps_mm.front() >= o.margin_mm && std::is_sorted(o.gaps_mm.begin(), o.gaps_mm.end());
  if (positive && gaps) return {};
  return Fail(ErrorCode::kUsage,
              "wound options: lengths must be positive, and the gaps ascending and not smaller than the margin");
}

/// One ring and the skin that it gives.
struct Attempt {
  Ring ring;
  RingWeights weights;
  Skin skin;
  RadialTrend trend;
};

std::optional<Attempt> Try(const Scene& scene, double gap_mm, const Options& options) {
  Attempt attempt;
  attempt.ring = TakeRing(scene, gap_mm, options.ring_width_mm);
  if (attempt.ring.coverage < kLeastCoverage || attempt.ring.empty_sectors > kMostEmptySectors) return std::nullopt;
  attempt.weights = WeighRing(attempt.ring.points);
  attempt.skin = FitSkin(SkinModel::kQuadricC4, attempt.ring.points, attempt.weights);
  // Against a stiff skin: a quartic bends with the swelling and hides it.
  attempt.trend = FindRadialTrend(attempt.ring, FitSkin(SkinModel::kQuadric, attempt.ring.points, attempt.weights));
  return attempt;
}

bool HasTrend(const Attempt& attempt, const Options& options) {
  return std::abs(attempt.trend.step_mm) > options.radial_trend_mm && std::abs(attempt.trend.t) > kTrendT;
}

/// The chosen ring, and what the neighbouring gaps would have given.
struct Choice {
  Attempt chosen;
  bool settled = false;
  double first_gap_mm = 0, first_volume_mm3 = 0;
  std::vector<double> other_gap_volumes_mm3;
};

Result<Choice> ChooseRing(const Scene& scene, const Bed& bed, const Options& options) {
  Choice choice;
  std::size_t at = 0;
  for (; at < options.gaps_mm.size(); ++at) {
    auto attempt = Try(scene, options.gaps_mm[at], options);
    if (!attempt && at == 0) {
      return Fail(ErrorCode::kMeasurementRefused,
                  "too little healthy skin around the outline: the ring of " +
                      Format("%.0f mm", options.ring_width_mm) +
                      " is cut off by the surface's edge or by holes; photograph with more skin around the wound");
    }
    if (!attempt) break;
    choice.chosen = *std::move(attempt);
    if (at == 0) {
      choice.first_gap_mm = options.gaps_mm[0];
      choice.first_volume_mm3 = PrismSum(bed, HeightsAbove(bed, choice.chosen.skin));
    }
    choice.settled = !HasTrend(choice.chosen, options);
    if (choice.settled) break;
  }
  for (std::size_t next = at + 1; next < std::min(at + 3, options.gaps_mm.size()); ++next) {
    const auto attempt = Try(scene, options.gaps_mm[next], options);
    if (attempt) choice.other_gap_volumes_mm3.push_back(PrismSum(bed, HeightsAbove(bed, attempt->skin)));
  }
  return choice;
}

Status CheckRing(const Choice& choice, const Options& options, Flags& flags) {
  const Attempt& a = choice.chosen;
  const double steep = SteepShare(a.ring, a.skin, options.max_ring_slope_deg);
  if (steep > kMostSteep) {
    return Fail(ErrorCode::kMeasurementRefused,
                "the skin around the outline bends away by more than " + Format("%.0f", options.max_ring_slope_deg) +
                    " degrees; it cannot be continued across the wound from one photograph");
  }
  if (a.weights.outlier_share > kMostOutliers) {
    return Fail(ErrorCode::kMeasurementRefused,
                "the skin around the outline is not one smooth surface (cloth, hair or background lies in the ring); "
                "uncover it and photograph again");
  }
  if (steep > 0.01) flags.inside.push_back("part of the surrounding skin is very steep");
  if (a.weights.outlier_share > kManyOutliers) {
    flags.inside.push_back(
        Format("%.0f %% of the surrounding skin was left out as not smooth", 100 * a.weights.outlier_share));
  }
  if (a.ring.coverage < kGoodCoverage) {
    flags.inside.push_back(Format("only %.0f %% of the surrounding ring of skin was seen", 100 * a.ring.coverage));
  }
  if (a.skin.fell_back) flags.inside.push_back("no quadric fits the surrounding skin; a quartic patch was used");
  if (!choice.settled) {
    flags.inside.push_back(Format("the skin is still uneven %.0f mm from the outline (swelling?)", a.ring.gap_mm));
  } else if (a.ring.gap_mm > choice.first_gap_mm) {
    flags.inside.push_back(
        Format("uneven skin near the wound: the ring of healthy skin begins %.0f mm out", a.ring.gap_mm));
  }
  return {};
}

double RootOfSquares(std::initializer_list<double> parts) {
  double sum = 0;
  for (const double p : parts) sum += p * p;
  return std::sqrt(sum);
}

double SdOf(double centre, const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += (v - centre) * (v - centre);
  return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

/// What other models of the skin say.
struct Alternatives {
  nlohmann::json table = nlohmann::json::array();
  double volume_sd_mm3 = 0, depth_sd_mm = 0;
};

Alternatives CompareModels(const Attempt& a, const Bed& bed, const Eigen::Vector2d& deepest) {
  Alternatives result;
  const double volume = PrismSum(bed, HeightsAbove(bed, a.skin));
  const double height = a.skin.Height(deepest.x(), deepest.y());
  double volume_gap = 0, height_gap = 0;
  for (const SkinModel model : {SkinModel::kC2, SkinModel::kC4, SkinModel::kQuadricC4}) {
    const Skin skin = FitSkin(model, a.ring.points, a.weights);
    const double other = PrismSum(bed, HeightsAbove(bed, skin));
    result.table.push_back(
        {{"model", std::string(ToString(model))}, {"net_volume_ml", other / 1000}, {"ring_rms_mm", skin.rms_mm}});
    if (skin.rms_mm > kComparableFit * a.skin.rms_mm + 1e-6 * a.skin.radius_mm) continue;
    volume_gap = std::max(volume_gap, std::abs(other - volume));
    height_gap = std::max(height_gap, std::abs(skin.Height(deepest.x(), deepest.y()) - height));
  }
  // The truth is as likely anywhere between the models: a rectangle of that half-width.
  result.volume_sd_mm3 = volume_gap / std::sqrt(3);
  result.depth_sd_mm = height_gap / std::sqrt(3);
  return result;
}

double SmoothedRingSd(const Scene& scene, const std::vector<double>& smoothed, const Ring& ring) {
  std::vector<double> size;
  for (std::size_t c = 0; c < scene.patch.size(); ++c) {
    const double d = scene.place[c].distance;
    if (scene.patch.state[c] == Patch::kMeasured && d >= ring.gap_mm && d <= ring.gap_mm + ring.width_mm) {
      size.push_back(std::abs(smoothed[c]));
    }
  }
  const auto middle = size.begin() + static_cast<std::ptrdiff_t>(size.size() / 2);
  std::nth_element(size.begin(), middle, size.end());
  return 1.4826 * *middle;
}

}  // namespace

std::string_view MethodVersion() { return "wound/1"; }

Result<AnalysisReport> Measure(const Surface& surface, const Outline& outline, const Options& options) {
  if (auto good = CheckOptions(options); !good) return Fail(good.error());
  auto plus = BuildScene(surface, outline, options);
  if (!plus) return Fail(plus.error());
  const Scene& scene = plus->scene;

  const Bed bed = TakeBed(scene, options.margin_mm);
  auto choice = ChooseRing(scene, bed, options);
  if (!choice) return Fail(choice.error());
  const Attempt& a = choice->chosen;
  Flags flags;
  if (auto good = CheckRing(*choice, options, flags); !good) return Fail(good.error());
  if (plus->boundary_share < 0.97) flags.all.push_back("part of the outline lies at an edge or hole of the surface");
  if (plus->hole_share > 0.02) {
    flags.inside.push_back(
        Format("%.0f %% of the surface inside the outline was missing and bridged", 100 * plus->hole_share));
  }

  auto net = VolumeBetween(MakeSheets(bed, a.skin));
  if (!net) return Fail(net.error(), "measuring the wound's volume");
  const double reach = a.ring.gap_mm + a.ring.width_mm;
  const auto smoothed = SmoothedHeights(scene, a.skin, options.smoothing_mm, reach);
  const double noise = SmoothedRingSd(scene, smoothed, a.ring);
  const Depths depths = MeasureDepths(scene, bed, a.skin, smoothed, 3 * noise);
  const Boundary boundary = MeasureBoundary(scene.outline, a.skin, options.perimeter_step_mm, scene.patch.cell_mm());

  // Uncertainty: the ring's correlated noise, the bed's, the choice of model and of gap, the drawn line, the scale.
  const SkinCovariance covariance = CovarianceOf(a.skin, a.ring, a.weights, options.ring_width_mm / 2);
  const Alternatives models = CompareModels(a, bed, depths.deepest);
  const double volume = *net + depths.proud_all_mm3;
  const double block_area = covariance.block_mm * covariance.block_mm;
  const double u_ring = VolumeSd(a.skin, covariance, bed);
  const double u_bed = covariance.block_mean_sd_mm * std::sqrt(boundary.plane_area_mm2 * block_area);
  const double u_gap = SdOf(*net, choice->other_gap_volumes_mm3);
  const auto net_at = [&](double margin) {
    const Bed other = TakeBed(scene, margin);
    return PrismSum(other, HeightsAbove(other, a.skin));
  };
  const double s = options.outline_sd_mm, scale = options.scale_relative_sd;
  const double u_outline = std::abs(net_at(options.margin_mm + s) - net_at(options.margin_mm - s)) / 2;
  const double u_volume = RootOfSquares({u_ring, u_bed, models.volume_sd_mm3, u_gap, u_outline, 3 * scale * volume});
  const double u_area = RootOfSquares({boundary.perimeter_mm * s, 2 * scale * boundary.area_mm2});
  const double u_skin_height = RootOfSquares({HeightSd(a.skin, covariance, depths.deepest), models.depth_sd_mm});
  const auto depth_sd = [&](double depth) { return RootOfSquares({u_skin_height, noise, scale * depth}); };

  if (std::abs(volume) < 2 * u_volume) flags.volume.push_back("not distinguishable from no wound");
  if (models.volume_sd_mm3 > 0.1 * std::abs(volume)) {
    flags.volume.push_back("models of the healthy skin disagree by more than 10 %");
  }

  const double mean_depth = volume / boundary.area_mm2;
  Figures figures;
  figures.volume = {volume, u_volume};
  figures.proud_volume = {depths.proud_mm3,
                          RootOfSquares({noise * std::sqrt(boundary.plane_area_mm2 * block_area),
                                         depths.proud_mm3 > 0 ? RootOfSquares({u_ring, models.volume_sd_mm3}) : 0})};
  figures.area = {boundary.area_mm2, u_area};
  figures.bed_area = {depths.bed_area_mm2, u_area * depths.bed_area_mm2 / boundary.area_mm2};
  figures.perimeter = {boundary.perimeter_mm, RootOfSquares({2 * M_PI * s, scale * boundary.perimeter_mm})};
  figures.depth_max = {depths.max_mm, depth_sd(depths.max_mm)};
  figures.depth_p95 = {depths.p95_mm, depth_sd(depths.p95_mm)};
  figures.depth_mean = {mean_depth,
                        RootOfSquares({u_volume / boundary.area_mm2, mean_depth * u_area / boundary.area_mm2})};
  figures.length = {boundary.length_mm, RootOfSquares({std::sqrt(2.0) * s, scale * boundary.length_mm})};
  figures.width = {boundary.width_mm, RootOfSquares({std::sqrt(2.0) * s, scale * boundary.width_mm})};

  AnalysisReport report;
  report.analysis = "wound";
  report.version = MethodVersion();
  report.provenance.version = StriaeVersion();
  report.provenance.parameters = ToJson(options);
  report.measurements = CodedMeasurements(figures, flags);
  report.details["skin"] = {{"model", std::string(ToString(a.skin.model))},
                            {"gap_mm", a.ring.gap_mm},
                            {"ring_width_mm", a.ring.width_mm},
                            {"ring_points", a.ring.points.size()},
                            {"ring_coverage", a.ring.coverage},
                            {"ring_rms_mm", a.skin.rms_mm},
                            {"radial_step_mm", a.trend.step_mm},
                            {"models", models.table}};
  report.details["net_volume_ml"] = *net / 1000;
  report.details["net_volume_at_first_gap_ml"] = choice->first_volume_mm3 / 1000;
  report.details["volume_uncertainty_parts_ml"] = {
      {"ring", u_ring / 1000}, {"bed", u_bed / 1000},         {"model", models.volume_sd_mm3 / 1000},
      {"gap", u_gap / 1000},   {"outline", u_outline / 1000}, {"scale", 3 * scale * volume / 1000}};
  report.details["hole_share"] = plus->hole_share;
  report.details["cell_mm"] = scene.patch.cell_mm();
  report.details["length_axis"] = "longest";
  return report;
}

}  // namespace striae::wound
