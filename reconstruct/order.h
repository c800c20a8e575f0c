// The whole number of stripes that unwrapping leaves open, for each region (OPTICS "Absolute stripe order").
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/calibration.h"
#include "reconstruct/phase.h"
#include "reconstruct/target.h"

namespace striae::reconstruct {

enum class OrderSource { kGratingEdge, kTarget, kDistance, kBridge, kNone };
/// CONTRACT's words: "grating-edge", "target", "distance", "bridge", "none".
std::string_view ToString(OrderSource source);

/// One end of the stripe field, seen on one region.
struct GratingEdge {
  double order = 0;    ///< relative order (phase / 2 pi) where the carrier falls to half of its plateau, median
  double scatter = 0;  ///< robust sd of it along the edge, stripes
  int lines = 0;       ///< lines across the stripes that show it
  double share = 0;    ///< of the region's lines
};

struct RegionEdges {
  std::optional<GratingEdge> low, high;  ///< at the small and the large orders
};

/// Looks along the lines of each of the first `regions` regions for the place where only the stripes end: the carrier
/// falls to half of its plateau while room light shows that the surface goes on without any modulation (dark cloth
/// keeps the modulation), and nothing further out on the line carries stripes (beyond a shadow they begin again). An
/// end is kept when the order along it is constant (sd < 0.13 stripe) over many lines, the region nowhere goes on past
/// it, and what lies beyond is not a wall that shows beside the region too; a subject's own border scatters by stripes.
std::vector<RegionEdges> FindGratingEdges(const PhaseResult& phase, int regions);

struct RegionOrder {
  std::size_t points = 0;
  OrderSource source = OrderSource::kNone;
  int offset = 0;     ///< whole stripes to add to phase / 2 pi
  double margin = 0;  ///< how much nearer the chosen whole number is than the next one: 1 = certain, 0 = a coin's toss
  std::string warning;  ///< what is doubtful and what to do; empty when nothing is
  int regions = 1;      ///< how many this entry stands for
};

/// One entry for each region, largest first. `distance_mm` is the expected distance (rig nominal or EXIF).
/// Every region asks its own grating edge and the label that lies on it; then the distance if that is unambiguous
/// within the working range, or the nearest settled region (the offset that continues its depth). The last two are
/// warned of. Where edge and label disagree the margin is 0, with a warning. Regions are taken as they are.
std::vector<RegionOrder> ResolveOrder(const PhaseResult& phase, const Calibration& calibration, double distance_mm,
                                      const std::optional<TargetSighting>& target = std::nullopt);

/// The same for a photograph whose regions may have been unwrapped across a step of whole stripes, which no phase
/// shows. Regions are parted where such a step may hide, put together again where the light shows that there is none
/// (docs/stripe-order.md), and what remains doubtful is a region of its own with a warning. No point is dropped;
/// `phase.unwrapped` has the new regions' numbers. `picture`: the photograph's colours, of the same size.
std::vector<RegionOrder> SettleOrder(PhaseResult& phase, const ImageRgb& picture, const Calibration& calibration,
                                     double distance_mm, const std::optional<TargetSighting>& target = std::nullopt);

/// For reports: the regions with at least a thousandth of all points (and the largest); the others are added up, those
/// without an order in one entry and those with one, which then carries the least margin among them, in another.
std::vector<RegionOrder> SummarisedRegions(const std::vector<RegionOrder>& regions);

}  // namespace striae::reconstruct
