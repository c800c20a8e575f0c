// What one region's whole number says about another's.
#pragma once

#include <optional>
#include <vector>

#include "reconstruct/detail/order_evidence.h"

namespace striae::reconstruct::detail {

/// Two regions that good pixels join.
struct Bridge {
  int from = 0, to = 0;  ///< from < to
  int step = 0;          ///< whole stripes to add to `to` so that it continues `from`
  double margin = 0;     ///< 0..1
};

/// Regions that only a thin cut separates: the amplitude goes on across it, slope and order too, along many lines that
/// all agree on the whole number. A step between surfaces dims the stripes somewhere along it, since its height is not
/// everywhere a whole number of stripes: where more than a few lines are dimmed there is no bridge.
std::vector<Bridge> FindBridges(const PhaseResult& phase, int regions);

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

/// Share of a region's area that hangs on its main part by narrow necks only (about three stripes wide): unwrapping
/// may have crossed a step of the surface there, where its height happens to be a whole number of stripes.
double ShareBehindNecks(const PhaseResult& phase, int region);

}  // namespace striae::reconstruct::detail
