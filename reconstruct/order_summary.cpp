// How the regions' orders are told.
#include <optional>
#include <string_view>
#include <vector>

#include "reconstruct/order.h"

namespace striae::reconstruct {

std::string_view ToString(OrderSource source) {
  switch (source) {
    case OrderSource::kGratingEdge:
      return "grating-edge";
    case OrderSource::kTarget:
      return "target";
    case OrderSource::kDistance:
      return "distance";
    case OrderSource::kBridge:
      return "bridge";
    case OrderSource::kNone:
      break;
  }
  return "none";
}

std::vector<RegionOrder> SummarisedRegions(const std::vector<RegionOrder>& regions) {
  std::size_t all = 0;
  for (const RegionOrder& region : regions) all += region.points;
  std::vector<RegionOrder> listed;
  std::optional<RegionOrder> placed, none;
  for (const RegionOrder& region : regions) {
    if (listed.empty() || region.points * 1000 >= all) {
      listed.push_back(region);
      continue;
    }
    auto& sum = region.source == OrderSource::kNone ? none : placed;
    if (!sum) {
      sum = region;
      continue;
    }
    sum->points += region.points;
    sum->regions += region.regions;
    if (region.margin < sum->margin || sum->warning.empty()) {
      const std::size_t points = sum->points;
      const int count = sum->regions;
      sum = region;
      sum->points = points;
      sum->regions = count;
    }
  }
  for (auto& sum : {placed, none}) {
    if (sum) listed.push_back(*sum);
  }
  return listed;
}

}  // namespace striae::reconstruct
