// What one region's whole number says about another's.
#pragma once

#include <optional>
#include <vector>

#include "reconstruct/detail/order_evidence.h"

namespace striae::reconstruct::detail {

/// Depth of the regions whose order is settled, on a coarse grid of the sensor.
class CoarseDepth {
 public:
  explicit CoarseDepth(const OrderScene& scene);

  /// Takes note; nothing is computed before Continued asks.
  void Add(int region, int offset) { noted_.emplace_back(region, offset); }
  /// The whole number that continues the depth of what is settled within about 100 px; always with a warning.
  [[nodiscard]] std::optional<RegionOrder> Continued(int region);

 private:
  void Place();  ///< what was noted
  template <typename Visit>
  void ForEachCell(int region, const Visit& visit) const;
  [[nodiscard]] double MeanAround(int col, int row) const;

  const OrderScene& scene_;
  std::vector<std::pair<int, int>> noted_;  ///< (region, offset)
  ImageF depth_;
  std::vector<std::vector<std::pair<int, int>>> cells_;  ///< (col, row) on the grid, of each region
};

}  // namespace striae::reconstruct::detail
