#include "analysis/wound/detail/budget.h"

#include <algorithm>
#include <cmath>

#include "analysis/wound/detail/surface_noise.h"
#include "analysis/wound/detail/uncertainty.h"

namespace striae::wound {
namespace {

constexpr double kComparableFit = 1.2;       // a model whose ring rms is worse than this does not fit, and says nothing
constexpr double kComparableScore = 1.5;     // nor one that continues intact skin worse than this
constexpr double kBridgeRelativeSd = 0.1;    // of the volume over bridged holes
constexpr double kBedAreaRelativeSd = 0.02;  // smoothing rounds the rim
constexpr double kWallsDepthSd = 0.005;      // of the 95th percentile, which lies where walls begin
constexpr double kDeepestSd = 0.0025;  // of the greatest depth: the calibration's scale, and what walls around it leave
constexpr double kBowlShare = 1.5;  // of what the kernel takes from a bowl of the wound's size: its walls are steeper

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

Alternatives CompareModels(const Attempt& a, const ModelChoice& choice, const Bed& bed, const Eigen::Vector2d& deepest,
                           bool settled) {
  Alternatives result;
  const double volume = PrismSum(bed, HeightsAbove(bed, a.skin));
  const double height = a.skin.Height(deepest.x(), deepest.y());
  const double best_mm = choice.score_mm[choice.model].value_or(0);
  double volume_gap = 0, height_gap = 0;
  for (std::size_t m = 0; m < kSkinModels.size(); ++m) {
    const Skin skin = FitSkin(kSkinModels[m], a.ring.points, a.weights);
    if (skin.fell_back && m > 0) continue;
    const double other = PrismSum(bed, HeightsAbove(bed, skin));
    const auto& score = choice.score_mm[m];
    result.table.push_back({{"model", std::string(ToString(kSkinModels[m]))},
                            {"net_volume_ml", other / 1000},
                            {"ring_rms_mm", skin.rms_mm},
                            {"score_mm", score ? nlohmann::json(*score) : nlohmann::json()}});
    // A model says something about this wound if it fits the ring, and intact skin, about as well. Where the skin bends
    // as no quadric does, intact skin beside the wound is no judge of the skin across it.
    if (skin.rms_mm > kComparableFit * a.skin.rms_mm + 1e-6 * a.skin.radius_mm) continue;
    if (settled && (!score || *score > kComparableScore * best_mm + 0.01)) continue;
    volume_gap = std::max(volume_gap, std::abs(other - volume));
    height_gap = std::max(height_gap, std::abs(skin.Height(deepest.x(), deepest.y()) - height));
  }
  // The truth is as likely anywhere between the models: a rectangle of that half-width.
  result.volume_sd_mm3 = volume_gap / std::sqrt(3);
  result.depth_sd_mm = height_gap / std::sqrt(3);
  return result;
}

/// Standard uncertainties of the volume, mm3.
struct VolumeParts {
  double ring = 0, bed = 0, model = 0, nulls = 0, gap = 0, outline = 0, surface = 0, bridges = 0, scale = 0;
  [[nodiscard]] double Sum() const {
    return RootOfSquares({ring, bed, model, nulls, gap, outline, surface, bridges, scale});
  }
};

nlohmann::json ToJson(const VolumeParts& u) {
  return {{"ring", u.ring / 1000},         {"bed", u.bed / 1000},         {"model", u.model / 1000},
          {"null_wounds", u.nulls / 1000}, {"gap", u.gap / 1000},         {"outline", u.outline / 1000},
          {"surface", u.surface / 1000},   {"bridges", u.bridges / 1000}, {"scale", u.scale / 1000}};
}

/// Standard uncertainties of the greatest depth, mm.
struct DepthParts {
  double ring = 0, model = 0, smoothed_ring = 0, fit = 0, surface = 0, bowl = 0, scale = 0;
  [[nodiscard]] double Sum() const { return RootOfSquares({ring, model, smoothed_ring, fit, surface, bowl, scale}); }
};

nlohmann::json ToJson(const DepthParts& u) {
  return {{"ring", u.ring},  {"model", u.model},     {"smoothed_ring", u.smoothed_ring},
          {"fit", u.fit},    {"surface", u.surface}, {"bowl", u.bowl},
          {"scale", u.scale}};
}

// How the volume changes when the drawn line moves out or in by its uncertainty.
double OutlinePart(const Scene& scene, const Skin& skin, double roughness_mm, const Options& options) {
  const double off_mm = RootOfSquares({options.outline_sd_mm, roughness_mm / 2});
  const auto net_at = [&](double margin_mm) {
    const Bed bed = TakeBed(scene, margin_mm);
    return PrismSum(bed, HeightsAbove(bed, skin));
  };
  return std::abs(net_at(options.margin_mm + off_mm) - net_at(options.margin_mm - off_mm)) / 2;
}

// Where a surface names no uncertainties: a wall's place, and light that changes at the rim while the bed begins to
// fall.
double WallsPart(const Findings& f, const Options& options) {
  return f.boundary.perimeter_mm *
         RootOfSquares({options.wall_sd_mm * f.depths.p95_mm, options.rim_share * f.resolution_mm * f.resolution_mm});
}

// Area: the line's shakes, and a common offset; lengths likewise, a shake at either end.
void SetLengths(const Boundary& boundary, const LineStudy& line, const Options& options, Figures& figures) {
  const double s = options.outline_sd_mm, scale = options.scale_relative_sd;
  const double ends = std::sqrt(2.0) * RootOfSquares({s, line.roughness / std::sqrt(2.0)});
  // The shakes that smoothing leaves lengthen or shorten it at random: about as much as at one end.
  const double shakes = RootOfSquares({2 * M_PI * s, 2 * line.roughness});
  figures.area = {boundary.area_mm2,
                  RootOfSquares({boundary.perimeter_mm * s, line.area_sd, 2 * scale * boundary.area_mm2})};
  figures.perimeter = {boundary.perimeter_mm, RootOfSquares({shakes, scale * boundary.perimeter_mm})};
  figures.length = {boundary.length_mm, RootOfSquares({ends, scale * boundary.length_mm})};
  figures.width = {boundary.width_mm, RootOfSquares({ends, scale * boundary.width_mm})};
}

}  // namespace

Budget DrawBudget(const Scene& scene, const Bed& bed, const Choice& choice, const ModelChoice& model,
                  const IntactSkin& intact, const Findings& f, const Options& options, Flags& flags) {
  const Attempt& a = choice.chosen;
  const double volume = f.net_mm3 + f.depths.proud_all_mm3, area = f.boundary.area_mm2;
  const SkinCovariance covariance = CovarianceOf(a.skin, a.ring, a.weights, options.ring_width_mm / 2);
  const Alternatives models = CompareModels(a, model, bed, f.depths.deepest, choice.settled);
  const double blocks_mm2 = std::sqrt(f.boundary.plane_area_mm2) * covariance.block_mm;

  VolumeParts u;
  u.ring = VolumeSd(a.skin, covariance, bed);
  u.bed = covariance.block_mean_sd_mm * blocks_mm2;
  u.model = models.volume_sd_mm3;
  u.nulls = intact.Rms(model.model, 2).value_or(0) * f.boundary.area_mm2;
  u.gap = SdOf(f.net_mm3, choice.other_gap_volumes_mm3);
  u.outline = OutlinePart(scene, a.skin, f.line.roughness, options);
  u.surface =
      f.skin_uncertainty_mm > 0 ? VolumeSdOfBed(scene, bed, f.skin_uncertainty_mm, f.stripe_mm) : WallsPart(f, options);
  u.bridges = kBridgeRelativeSd * f.depths.bridged_mm3;
  u.scale = 3 * options.scale_relative_sd * volume;
  if (std::abs(volume) < 2 * u.Sum()) flags.volume.push_back("not distinguishable from no wound");
  if (u.model > 0.1 * std::abs(volume)) {
    flags.volume.push_back("models of the healthy skin disagree by more than 10 %");
  }

  Budget budget;
  Figures& figures = budget.figures;
  SetLengths(f.boundary, f.line, options, figures);
  figures.volume = {volume, u.Sum()};
  const double u_proud = f.depths.proud_mm3 > 0 ? RootOfSquares({u.ring, u.model}) : 0;
  figures.proud_volume = {f.depths.proud_mm3, RootOfSquares({f.noise_mm * blocks_mm2, u_proud})};
  const double bed_area = f.depths.bed_area_mm2;
  figures.bed_area = {bed_area,
                      RootOfSquares({figures.area.uncertainty * bed_area / area, kBedAreaRelativeSd * bed_area})};
  // d (1 - r^2 / R^2) loses half its second derivative times s^2; the fitted quadric gives back what it sees of it.
  const double bowl_mm =
      f.deepest.depth_mm * f.resolution_mm * f.resolution_mm * M_PI / std::max(f.boundary.plane_area_mm2, 1e-9);
  DepthParts d;
  d.ring = HeightSd(a.skin, covariance, f.depths.deepest);
  d.model = models.depth_sd_mm;
  d.smoothed_ring = f.noise_mm;
  d.fit = f.deepest.noise_mm;
  d.surface = f.skin_uncertainty_mm > 0 ? f.deepest.surface_mm : (f.deepest.depth_mm - f.depths.max_mm) / 2;
  d.bowl = kBowlShare * bowl_mm;
  d.scale = kDeepestSd * f.deepest.depth_mm;
  figures.depth_max = {f.deepest.depth_mm, d.Sum()};
  figures.depth_p95 = {f.depths.p95_mm,
                       RootOfSquares({d.ring, d.model, d.smoothed_ring, d.surface, kWallsDepthSd * f.depths.p95_mm})};
  figures.depth_mean = {volume / area,
                        RootOfSquares({u.Sum() / area, volume / area * figures.area.uncertainty / area})};
  budget.models = models.table;
  budget.volume_parts_ml = ToJson(u);
  budget.depth_parts_mm = ToJson(d);
  return budget;
}

}  // namespace striae::wound
