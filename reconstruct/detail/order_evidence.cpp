#include "reconstruct/detail/order_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "reconstruct/detail/order_lines.h"

namespace striae::reconstruct::detail {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kLow = -0.52, kHigh = -0.5;   ///< where half of the plateau is: at this, and at N plus this
constexpr double kLargestRemainder = 0.12;     ///< stripes; true ends scatter by 0.06, a wrong one is anywhere
constexpr double kLargestDisagreement = 0.25;  ///< of the two ends' distance from N

/// Median over the samples of the order that a depth predicts minus the measured one; NaN without samples.
double PredictedOffset(const OrderScene& scene, const std::vector<RegionSample>& samples, double depth_mm) {
  std::vector<double> offsets;
  for (const RegionSample& sample : samples) {
    if (const auto order = scene.optics.OrderAt(depth_mm * sample.ray)) offsets.push_back(*order - sample.order);
  }
  return offsets.empty() ? std::numeric_limits<double>::quiet_NaN() : MedianOf(offsets);
}

/// The whole number leaves the region within the working range and within the grating's stripes.
bool Possible(const OrderScene& scene, const std::vector<RegionSample>& samples, int offset, int stripes) {
  constexpr double kMostOutside = 0.03, kBeyond = 0.5;
  const double slack = RangeSlack(scene.calibration);
  std::size_t unlit = 0;
  std::vector<double> depths;
  for (const RegionSample& sample : samples) {
    const double order = sample.order + offset;
    unlit += order < -0.5 - kBeyond || order > stripes - 0.5 + kBeyond ? 1 : 0;
    if (const auto depth = scene.optics.DepthAt(sample.ray, order)) depths.push_back(*depth);
  }
  if (depths.empty() || static_cast<double>(unlit) > kMostOutside * static_cast<double>(samples.size())) return false;
  const double middle = MedianOf(depths);
  return middle > scene.calibration.near_mm - slack && middle < scene.calibration.far_mm + slack;
}

}  // namespace

std::vector<std::vector<RegionSample>> SampleRegions(const OrderScene& scene, int regions) {
  const auto& region = scene.phase.unwrapped.region;
  const int step = std::max(2, region.width() / 200);  // medians of thousands
  std::vector<std::vector<RegionSample>> samples(static_cast<std::size_t>(regions));
  for (int row = step / 2; row < region.height(); row += step) {
    for (int col = step / 2; col < region.width(); col += step) {
      const int r = region(col, row);
      if (r < 0 || r >= regions) continue;
      samples[static_cast<std::size_t>(r)].push_back(
          {RayOf(scene.calibration.camera, {static_cast<double>(col), static_cast<double>(row)}),
           scene.phase.unwrapped.phase(col, row) / kTwoPi});
    }
  }
  return samples;
}

std::optional<RegionOrder> FromEdges(const OrderScene& scene, const std::vector<RegionSample>& samples,
                                     const RegionEdges& edges) {
  if (!scene.calibration.stripes || (!edges.low && !edges.high)) return std::nullopt;
  const int stripes = *scene.calibration.stripes;
  const double low = edges.low ? kLow - edges.low->order : 0;
  const double high = edges.high ? stripes + kHigh - edges.high->order : 0;
  if (edges.low && edges.high && std::abs(low - high) > kLargestDisagreement) return std::nullopt;
  const double offset = edges.low && edges.high ? (low + high) / 2 : (edges.low ? low : high);
  RegionOrder found;
  found.source = OrderSource::kGratingEdge;
  found.offset = static_cast<int>(std::lround(offset));
  const double remainder = std::abs(offset - found.offset);
  if (remainder > kLargestRemainder || !Possible(scene, samples, found.offset, stripes)) return std::nullopt;
  found.margin = 1 - 2 * remainder;
  return found;
}

RegionOrder FromDistance(const OrderScene& scene, const std::vector<RegionSample>& samples, double distance_mm) {
  const double expected = PredictedOffset(scene, samples, distance_mm);
  const double at_near = PredictedOffset(scene, samples, scene.calibration.near_mm);
  const double at_far = PredictedOffset(scene, samples, scene.calibration.far_mm);
  RegionOrder found;
  if (!std::isfinite(expected)) {
    found.warning = "nothing fixes this region's whole stripe number; it is not measured";
    return found;
  }
  found.source = OrderSource::kDistance;
  found.offset = static_cast<int>(std::lround(expected));
  found.margin = 1 - 2 * std::abs(expected - found.offset);
  const double candidates = std::abs(at_far - at_near);
  if (!(candidates <= 1)) {
    found.margin /= std::isfinite(candidates) ? candidates : 2;
    found.warning =
        "the stripe order rests on the expected distance of " + std::to_string(std::lround(distance_mm)) +
        " mm alone, and other whole numbers fit the working range too; let the grating's edge or a label fall on the "
        "subject, or give --distance-mm";
  }
  return found;
}

std::optional<RegionOrder> Agreed(std::optional<RegionOrder> edge, std::optional<RegionOrder> target) {
  if (!edge || !target) return edge ? edge : target;
  if (edge->offset == target->offset) {
    edge->margin = std::max(edge->margin, target->margin);
    return edge;
  }
  edge->margin = 0;
  edge->warning = "the grating's edge and the label disagree by " +
                  std::to_string(std::abs(edge->offset - target->offset)) +
                  " stripes; check the label's side length, and that the calibration is this rig's";
  return edge;
}

}  // namespace striae::reconstruct::detail
