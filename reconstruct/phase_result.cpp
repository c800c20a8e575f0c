// What follows from a measured phase alone.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "reconstruct/phase.h"

namespace striae::reconstruct {

LocalPeriods FollowPeriod(const PhaseResult& phase) {
  constexpr double kTurn = 2 * std::numbers::pi;
  constexpr std::size_t kEvery = 499;  // pixels: a prime, no column or stripe is preferred
  const Unwrapped& unwrapped = phase.unwrapped;
  const auto width = static_cast<std::size_t>(unwrapped.phase.width());
  const auto half = static_cast<std::size_t>(std::max(1L, std::lround(phase.carrier_period_px / 2)));
  const bool horizontal = phase.direction == StripeDirection::kHorizontal;
  const std::size_t step = horizontal ? half * width : half;
  std::vector<double> periods;
  for (std::size_t i = 0; i + step < unwrapped.phase.size(); i += kEvery) {
    const std::size_t j = i + step;
    const std::int32_t region = unwrapped.region.pixels()[i];
    if (region < 0 || region != unwrapped.region.pixels()[j] || (!horizontal && i % width + half >= width)) continue;
    if (!phase.FitsAt(i) || !phase.FitsAt(j)) continue;
    const auto turns = static_cast<double>(unwrapped.phase.pixels()[j] - unwrapped.phase.pixels()[i]) / kTurn;
    if (turns > 0) periods.push_back(static_cast<double>(half) / turns);
  }
  if (periods.empty()) return {};
  const auto at = [&](double share) {
    const auto place = periods.begin() + static_cast<long>(share * static_cast<double>(periods.size() - 1));
    std::nth_element(periods.begin(), place, periods.end());
    return *place;
  };
  return {at(0.05), at(0.95)};
}

Mask MeasuredMask(const PhaseResult& phase) {
  Mask measured = Mask::Unset(phase.mask.width(), phase.mask.height());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    measured.pixels()[i] = phase.mask.pixels()[i] != 0 && phase.FitsAt(i) ? 1 : 0;
  }
  return measured;
}

}  // namespace striae::reconstruct
