// What each kind of evidence says about one region's whole number of stripes.
#pragma once

#include <optional>
#include <vector>

#include "core/optics.h"
#include "reconstruct/order.h"

namespace striae::reconstruct::detail {

/// A photograph's regions with the optics that they were seen through.
struct OrderScene {
  const PhaseResult& phase;
  const Calibration& calibration;
  StripeOptics optics;
};

/// How far beyond its working range a region may still lie, mm: 12 % of the range's middle.
inline double RangeSlack(const Calibration& calibration) {
  return 0.12 * (calibration.near_mm + calibration.far_mm) / 2;
}

/// A pixel of a region: its ray (z = 1) and its relative order in stripes.
struct RegionSample {
  Eigen::Vector3d ray;
  double order = 0;
};

/// Up to a few thousand pixels of each of the first `regions` regions, evenly spread.
std::vector<std::vector<RegionSample>> SampleRegions(const OrderScene& scene, int regions);

/// From the ends of the grating: -0.5 and N - 0.5, within what was measured on true ends. Nothing when they disagree,
/// when the region would then lie outside of the working range, or be lit by stripes that the grating does not have.
std::optional<RegionOrder> FromEdges(const OrderScene& scene, const std::vector<RegionSample>& samples,
                                     const RegionEdges& edges);

/// From the plane of a label that lies on the region. Nothing where it lies on another one.
std::optional<RegionOrder> FromTarget(const OrderScene& scene, int region, const TargetSighting& target);

/// The distance decides where only one whole number leaves the region's middle within the working range; otherwise the
/// one nearest to the expected distance is taken with a warning.
RegionOrder FromDistance(const OrderScene& scene, const std::vector<RegionSample>& samples, double distance_mm);

/// The label is the stronger word where the region has no edge; where both speak and disagree neither is believed.
std::optional<RegionOrder> Agreed(std::optional<RegionOrder> edge, std::optional<RegionOrder> target);

}  // namespace striae::reconstruct::detail
