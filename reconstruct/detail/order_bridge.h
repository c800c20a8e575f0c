// What one region's whole number says about another's.
#pragma once

#include <optional>
#include <vector>

#include "reconstruct/detail/order_evidence.h"

namespace striae::reconstruct::detail {

/// On how many lines, a third of a stripe apart, each of the first `regions` regions has a shadow that its own order
/// does not know of: no light for about a stripe or more, and on both sides one surface. What casts it may stand before
/// the rest, whole stripes nearer. Dark paint is not meant: it keeps the modulation.
std::vector<int> ShadowedLines(const PhaseResult& phase, int regions);

/// Depth of the regions whose order is settled, on a coarse grid of the sensor.
class CoarseDepth {
 public:
  explicit CoarseDepth(const OrderScene& scene);

  void Add(int region, int offset);
  /// The whole number that continues the depth of what is settled within about 100 px; always with a warning.
  [[nodiscard]] std::optional<RegionOrder> Continued(int region) const;

 private:
  template <typename Visit>
  void ForEachCell(int region, const Visit& visit) const;
  [[nodiscard]] double MeanAround(int col, int row) const;

  const OrderScene& scene_;
  ImageF depth_;
  std::vector<std::vector<std::pair<int, int>>> cells_;  ///< (col, row) on the grid, of each region
};

}  // namespace striae::reconstruct::detail
