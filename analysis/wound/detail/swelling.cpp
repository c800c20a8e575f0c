#include "analysis/wound/detail/swelling.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace striae::wound {
namespace {

constexpr double kWidth = 14;
constexpr double kLeastCoverage = 0.5, kMostEmptySectors = 0.4;
constexpr double kMostMisfit_mm = 0.06, kMostMisfitShare = 0.1, kMostMisfitEver_mm = 0.2;  // of the outer skin
constexpr int kSectors = 24;

double Median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Median over sectors of the mean height above the skin, for each millimetre outwards from the line.
std::vector<double> ProfileOf(const Scene& scene, const Skin& skin, double to_mm) {
  const auto steps = static_cast<std::size_t>(to_mm);
  struct Mean {
    double sum = 0, count = 0;
  };
  std::vector<std::array<Mean, kSectors>> bins(steps);
  for (std::size_t c = 0; c < scene.patch.size(); ++c) {
    const auto& place = scene.place[c];
    if (scene.patch.state[c] != Patch::kMeasured || !(place.distance >= 0) || !(place.distance < to_mm)) continue;
    const auto step = std::min(steps - 1, static_cast<std::size_t>(place.distance));
    const auto sector = std::min<std::size_t>(kSectors - 1, static_cast<std::size_t>(place.along * kSectors));
    const auto& p = scene.local[c];
    bins[step][sector].sum += p.z() - skin.Height(p.x(), p.y());
    bins[step][sector].count += 1;
  }
  std::vector<double> profile;
  for (const auto& step : bins) {
    std::vector<double> means;
    for (const Mean& mean : step) {
      if (mean.count > 0) means.push_back(mean.sum / mean.count);
    }
    profile.push_back(means.empty() ? 0 : Median(means));
  }
  return profile;
}

double MeanOver(const std::vector<double>& profile, std::size_t from, std::size_t to) {
  double sum = 0;
  for (std::size_t k = from; k < to; ++k) sum += profile[k];
  return sum / static_cast<double>(to - from);
}

}  // namespace

Swelling FindSwelling(const Scene& coarse, double least_mm, double threshold_mm) {
  Swelling found;
  for (const double outer_mm : {10.0, 14.0, 18.0, 22.0, 26.0}) {
    const Ring ring = TakeRing(coarse, outer_mm, kWidth);
    if (ring.points.size() < 200 || ring.coverage < kLeastCoverage || ring.empty_sectors > kMostEmptySectors) break;
    const RingWeights weights = WeighRing(ring.points);
    const Skin skin = FitSkin(SkinModel::kQuadric, ring.points, weights);
    if (skin.fell_back) break;
    found.outer_mm = outer_mm;
    found.profile_mm = ProfileOf(coarse, skin, outer_mm + kWidth);
    const auto at = static_cast<std::size_t>(outer_mm);
    found.height_mm = MeanOver(found.profile_mm, 2, 5);  // the first millimetres are the line's own doubt
    double misfit = 0;
    for (std::size_t k = at; k < found.profile_mm.size(); ++k) misfit = std::max(misfit, std::abs(found.profile_mm[k]));
    const double share_mm = std::min(kMostMisfitShare * found.height_mm, kMostMisfitEver_mm);
    found.looked = misfit < std::max(kMostMisfit_mm, share_mm);
    if (std::abs(MeanOver(found.profile_mm, at - 4, at)) < threshold_mm) break;
  }
  if (!found.looked) return found;
  if (found.height_mm < least_mm) return found;
  const double low = std::max(threshold_mm / 2, 0.03 * found.height_mm);
  found.ends_mm = found.outer_mm;
  while (found.ends_mm > 1 && found.profile_mm[static_cast<std::size_t>(found.ends_mm) - 1] < low) --found.ends_mm;
  return found;
}

}  // namespace striae::wound
