#include "analysis/wound/detail/choice.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace striae::wound {
namespace {

constexpr double kLeastCoverage = 0.6, kGoodCoverage = 0.9;
constexpr double kMostEmptySectors = 0.25;
constexpr double kMostSteep = 0.1, kMostOutliers = 0.3, kManyOutliers = 0.1;
constexpr double kTrendT = 3;
constexpr double kNoQuadric = 5;  // times q+c4's rms: the step is the body's shape, of which a quartic takes care
constexpr double kFades = 0.7;    // of the step beside the line that is left further out where it is swelling
constexpr double kLeastSwelling_mm = 0.1, kSwellingStep_mm = 0.05;

/// The same wound in small cells near it and in large ones far out.
struct Scenes {
  const Scene &fine, &coarse;
};

std::optional<Attempt> Try(const Scenes& scenes, double gap_mm, double width_mm) {
  Attempt attempt;
  attempt.ring = TakeRing(gap_mm < kCoarseFrom_mm ? scenes.fine : scenes.coarse, gap_mm, width_mm);
  if (attempt.ring.coverage < kLeastCoverage || attempt.ring.empty_sectors > kMostEmptySectors) return std::nullopt;
  attempt.weights = WeighRing(attempt.ring.points);
  attempt.skin = FitSkin(SkinModel::kQuadricC4, attempt.ring.points, attempt.weights);
  // Against a stiff skin: a quartic bends with the swelling and hides it.
  const Skin stiff = FitSkin(SkinModel::kQuadric, attempt.ring.points, attempt.weights);
  attempt.trend = FindRadialTrend(attempt.ring, stiff);
  attempt.quadric_rms_mm = stiff.rms_mm;
  return attempt;
}

// Rms over sectors of the mean error with which the rest of the ring foretells each.
std::optional<double> SectorScore(const Attempt& attempt, SkinModel model) {
  constexpr int kSectors = 12;
  const Ring& ring = attempt.ring;
  double squares = 0, count = 0;
  for (int left_out = 0; left_out < kSectors; ++left_out) {
    RingWeights kept = attempt.weights;
    const auto is_out = [&](std::size_t k) { return static_cast<int>(ring.places[k].along * kSectors) == left_out; };
    for (std::size_t k = 0; k < ring.points.size(); ++k) kept.weight[k] *= is_out(k) ? 0 : 1;
    const Skin skin = FitSkin(model, ring.points, kept);
    if (skin.fell_back) return std::nullopt;
    double sum = 0, weight = 0;
    for (std::size_t k = 0; k < ring.points.size(); ++k) {
      if (!is_out(k)) continue;
      sum += attempt.weights.weight[k] * (ring.points[k].z() - skin.Height(ring.points[k].x(), ring.points[k].y()));
      weight += attempt.weights.weight[k];
    }
    if (weight <= 0) continue;
    squares += sum * sum / (weight * weight);
    ++count;
  }
  if (count < kSectors / 2) return std::nullopt;
  return std::sqrt(squares / count);
}

// The ring with at most `most` points, for fits that are repeated many times.
Attempt Thinned(const Attempt& attempt, std::size_t most) {
  Attempt thin = attempt;
  const std::size_t stride = (attempt.ring.points.size() + most - 1) / most;
  if (stride <= 1) return thin;
  thin.ring.points.clear();
  thin.ring.places.clear();
  thin.weights.weight.clear();
  for (std::size_t k = 0; k < attempt.ring.points.size(); k += stride) {
    thin.ring.points.push_back(attempt.ring.points[k]);
    thin.ring.places.push_back(attempt.ring.places[k]);
    thin.weights.weight.push_back(attempt.weights.weight[k]);
  }
  return thin;
}

bool HasTrend(const Attempt& attempt, const Options& options) {
  return std::abs(attempt.trend.step_mm) > options.radial_trend_mm && std::abs(attempt.trend.t) > kTrendT;
}

// Tries the gaps outwards with one width of the ring.
Result<Choice> ChooseRing(const Scenes& scenes, const Bed& bed, double width_mm, const Swelling& swelling,
                          const Options& options) {
  Choice choice;
  choice.swelling = swelling;
  const auto volume_of = [&](const Attempt& attempt) { return PrismSum(bed, HeightsAbove(bed, attempt.skin)); };
  auto first = Try(scenes, options.gaps_mm.front(), width_mm);
  if (!first) {
    return Fail(ErrorCode::kMeasurementRefused,
                "too little healthy skin around the outline: the ring of " + Format("%.0f mm", width_mm) +
                    " is cut off by the surface's edge or by holes; photograph with more skin around the wound");
  }
  choice.first_gap_mm = options.gaps_mm.front();
  choice.first_volume_mm3 = volume_of(*first);
  choice.chosen = *std::move(first);
  choice.settled = swelling.looked ? swelling.ends_mm == 0 : !HasTrend(choice.chosen, options);
  std::vector<double> gaps = options.gaps_mm;
  if (swelling.ends_mm > 0) gaps = {options.gaps_mm.front(), swelling.ends_mm, swelling.ends_mm + 2};
  std::size_t at = 0;
  const Attempt beside = choice.chosen;
  const bool shaped = !swelling.looked && beside.quadric_rms_mm > kNoQuadric * beside.skin.rms_mm;
  while (!choice.settled && !shaped && ++at < gaps.size()) {
    if (gaps[at] <= choice.first_gap_mm) continue;
    auto attempt = Try(scenes, gaps[at], width_mm);
    // Skin further out that has turned away says less about the wound's place than uneven skin beside it.
    if (!attempt || SteepShare(attempt->ring, attempt->skin, options.max_ring_slope_deg) > kMostSteep) break;
    choice.chosen = *std::move(attempt);
    choice.settled = swelling.ends_mm > 0 || !HasTrend(choice.chosen, options);
  }
  // Swelling fades outwards. What does not is the body's own shape, which no quadric is (a heel): the nearest ring then
  // continues it best.
  if (!choice.settled && std::abs(choice.chosen.trend.step_mm) > kFades * std::abs(beside.trend.step_mm)) {
    choice.chosen = beside;
    at = 0;
  }
  for (std::size_t next = at + 1; next < std::min(at + 3, gaps.size()); ++next) {
    const auto attempt = Try(scenes, gaps[next], width_mm);
    if (attempt) choice.other_gap_volumes_mm3.push_back(volume_of(*attempt));
  }
  return choice;
}

}  // namespace

std::string Format(const char* format, double value) {
  char text[200];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

Result<Choice> ChooseRing(const Scene& scene, const Scene& coarse, const Bed& bed, const Options& options) {
  const Scenes scenes{scene, coarse};
  const Swelling swelling = FindSwelling(coarse, kLeastSwelling_mm, kSwellingStep_mm);
  auto choice = ChooseRing(scenes, bed, options.ring_width_mm, swelling, options);
  if (!choice) return choice;
  if (SteepShare(choice->chosen.ring, choice->chosen.skin, options.max_ring_slope_deg) <= kMostSteep) return choice;
  // On round bodies the ring's outer part bends away: less of its width may do.
  constexpr double kNarrower = 0.7;
  return ChooseRing(scenes, bed, kNarrower * options.ring_width_mm, swelling, options);
}

ModelChoice ChooseModel(const Attempt& attempt, const IntactSkin& intact) {
  constexpr std::size_t kLeastNulls = 3;
  constexpr double kBetter = 0.67, kFloor_mm = 0.01;
  ModelChoice choice;
  const bool by_nulls = intact.wounds.size() >= kLeastNulls;
  choice.by = by_nulls ? "null wounds" : "sectors of the ring";
  const Attempt thin = by_nulls ? Attempt{} : Thinned(attempt, 3000);
  for (std::size_t m = 0; m < kSkinModels.size(); ++m) {
    choice.score_mm[m] = by_nulls ? intact.Rms(m, intact.wounds.size()) : SectorScore(thin, kSkinModels[m]);
    if (m == 0 || !choice.score_mm[m]) continue;
    const auto& best = choice.score_mm[choice.model];
    const double bar = choice.model == 0 ? kBetter : 1;
    if (!best || *choice.score_mm[m] + kFloor_mm < bar * (*best + kFloor_mm)) choice.model = m;
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
  if (a.ring.width_mm < 0.99 * options.ring_width_mm) {
    flags.inside.push_back(Format("the skin bends away: a ring of only %.1f mm was used", a.ring.width_mm));
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
  if (choice.swelling.ends_mm > 0) {
    flags.inside.push_back("the skin beside the wound is swollen by " + Format("%.1f mm", choice.swelling.height_mm) +
                           ": the ring of healthy skin begins " + Format("%.0f mm out", a.ring.gap_mm) +
                           Format(", where the swelling ends (%.0f mm)", choice.swelling.ends_mm));
  } else if (!choice.settled && a.ring.gap_mm <= choice.first_gap_mm) {
    flags.inside.push_back("the skin's shape is no quadric's, so that swelling beside the wound would not be seen");
  } else if (!choice.settled) {
    flags.inside.push_back(Format("the skin is still uneven %.0f mm from the outline (swelling?)", a.ring.gap_mm));
  } else if (a.ring.gap_mm > choice.first_gap_mm) {
    flags.inside.push_back(
        Format("uneven skin near the wound: the ring of healthy skin begins %.0f mm out", a.ring.gap_mm));
  }
  return {};
}

}  // namespace striae::wound
