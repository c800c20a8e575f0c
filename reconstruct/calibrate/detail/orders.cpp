#include "reconstruct/calibrate/detail/orders.h"

#include <algorithm>
#include <cmath>

namespace striae::reconstruct::detail {

Settled SettleOffsets(const std::vector<double>& offsets) {
  double cosine = 0, sine = 0;
  for (const double offset : offsets) {
    cosine += std::cos(2 * M_PI * offset);
    sine += std::sin(2 * M_PI * offset);
  }
  Settled settled;
  settled.fraction = std::atan2(sine, cosine) / (2 * M_PI);
  for (const double offset : offsets) {
    settled.whole.push_back(std::round(offset - settled.fraction));
    settled.distance.push_back(offset - settled.fraction - settled.whole.back());
  }
  return settled;
}

std::optional<int> GaugeFromEdges(const std::vector<SeenEdges>& edges, const std::vector<double>& offsets,
                                  std::optional<int> stripes) {
  if (!stripes) return std::nullopt;
  std::vector<double> shifts;
  for (std::size_t v = 0; v < edges.size(); ++v) {
    if (edges[v].low) shifts.push_back(-0.5 - (*edges[v].low + offsets[v]));
    if (edges[v].high) shifts.push_back(*stripes - 0.5 - (*edges[v].high + offsets[v]));
  }
  if (shifts.empty()) return std::nullopt;
  std::nth_element(shifts.begin(), shifts.begin() + static_cast<long>(shifts.size() / 2), shifts.end());
  const double median = shifts[shifts.size() / 2];
  const auto agrees = [&](double shift) { return std::abs(shift - median) < 0.3; };
  const auto agreeing = std::count_if(shifts.begin(), shifts.end(), agrees);
  if (3 * agreeing < 2 * static_cast<long>(shifts.size()) || std::abs(median - std::round(median)) > 0.3)
    return std::nullopt;
  return static_cast<int>(std::lround(median));
}

}  // namespace striae::reconstruct::detail
