#include "reconstruct/order.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "reconstruct/detail/order_bridge.h"
#include "reconstruct/detail/order_evidence.h"

namespace striae::reconstruct {
namespace {

constexpr int kMostAnchored = 64;          ///< regions that are asked for evidence of their own
constexpr double kLeastMargin = 0.4;       ///< below it a region without an anchor of its own is left out
constexpr double kNoteworthyNecks = 0.03;  ///< share of a region behind necks

/// The regions' orders while they are being settled.
class Resolver {
 public:
  Resolver(const PhaseResult& phase, const Calibration& calibration, double distance_mm)
      : scene_{phase, calibration, StripeOptics(calibration)},
        distance_mm_(distance_mm),
        count_(phase.unwrapped.regions),
        asked_(std::min(count_, kMostAnchored)),
        orders_(static_cast<std::size_t>(count_)),
        settled_(static_cast<std::size_t>(count_), false),
        depth_(scene_) {
    for (const int region : phase.unwrapped.region.pixels()) {
      if (region >= 0) ++orders_[static_cast<std::size_t>(region)].points;
    }
    samples_ = detail::SampleRegions(scene_, asked_);
  }

  /// Grating edges and label: each region by itself.
  void Anchor(const std::optional<TargetSighting>& target) {
    const auto edges = FindGratingEdges(scene_.phase, asked_);
    for (int r = 0; r < asked_; ++r) {
      const auto i = static_cast<std::size_t>(r);
      auto own = detail::Agreed(detail::FromEdges(scene_, samples_[i], edges[i]),
                                target ? detail::FromTarget(scene_, r, *target) : std::nullopt);
      if (own) Settle(r, *std::move(own));
    }
  }

  /// Along bridges of good pixels from what is settled, the widest first, until nothing more is reached.
  void CrossBridges() {
    auto bridges = detail::FindBridges(scene_.phase, asked_);
    std::stable_sort(bridges.begin(), bridges.end(), [](const auto& a, const auto& b) { return a.margin > b.margin; });
    for (bool any = true; any;) {
      any = false;
      for (const detail::Bridge& bridge : bridges) any = Cross(bridge) || any;
    }
  }

  /// What has no anchor, always with a warning: the largest region from the distance when nothing is settled, the
  /// others beside what is.
  void Continue() {
    for (int r = 0; r < count_; ++r) {
      if (settled_[static_cast<std::size_t>(r)]) continue;
      std::optional<RegionOrder> found;
      if (r > 0) found = depth_.Continued(r);
      if (!found && r < asked_)
        found = detail::FromDistance(scene_, samples_[static_cast<std::size_t>(r)], distance_mm_);
      if (r > 0 && (!found || found->margin < kLeastMargin)) {
        found = RegionOrder{};
        found->warning = "nothing fixes this region's whole stripe number; it is left out of the surface";
      }
      Settle(r, *std::move(found));
    }
  }

  /// Large regions whose parts unwrapping may have joined across a step.
  void DoubtNecks() {
    const std::size_t least = scene_.phase.mask.size() / 500;
    for (int r = 0; r < asked_; ++r) {
      RegionOrder& order = orders_[static_cast<std::size_t>(r)];
      if (order.points < least || !order.warning.empty()) continue;
      const double share = detail::ShareBehindNecks(scene_.phase, r);
      if (share < kNoteworthyNecks) continue;
      order.warning =
          std::to_string(std::lround(100 * share)) +
          " % of it hang on the rest by narrow necks only and may be off by whole stripes; look for steps in "
          "depth that should not be there";
    }
  }

  std::vector<RegionOrder> Take() { return std::move(orders_); }

 private:
  void Settle(int region, RegionOrder found) {
    const auto i = static_cast<std::size_t>(region);
    found.points = orders_[i].points;
    orders_[i] = std::move(found);
    settled_[i] = true;
    if (orders_[i].source != OrderSource::kNone) depth_.Add(region, orders_[i].offset);
  }

  bool Cross(const detail::Bridge& bridge) {
    const auto from = static_cast<std::size_t>(bridge.from), to = static_cast<std::size_t>(bridge.to);
    if (settled_[from] == settled_[to]) {
      if (settled_[from] && orders_[from].offset + bridge.step != orders_[to].offset) Doubt(from, to);
      return false;
    }
    const bool forward = settled_[from];
    const RegionOrder& known = orders_[forward ? from : to];
    RegionOrder found;
    found.source = OrderSource::kBridge;
    found.offset = known.offset + (forward ? bridge.step : -bridge.step);
    found.margin = std::min(known.margin, bridge.margin);
    found.warning = known.warning;
    Settle(forward ? bridge.to : bridge.from, std::move(found));
    return true;
  }

  /// Two anchored regions that good pixels join, and whose whole numbers do not continue each other.
  void Doubt(std::size_t a, std::size_t b) {
    for (const std::size_t i : {a, b}) {
      if (!orders_[i].warning.empty()) continue;
      orders_[i].margin = 0;
      orders_[i].warning = "its whole stripe number does not continue that of the region it is joined to";
    }
  }

  detail::OrderScene scene_;
  double distance_mm_;
  int count_, asked_;
  std::vector<RegionOrder> orders_;
  std::vector<bool> settled_;
  detail::CoarseDepth depth_;
  std::vector<std::vector<detail::RegionSample>> samples_;
};

}  // namespace

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

std::vector<RegionOrder> ResolveOrder(const PhaseResult& phase, const Calibration& calibration, double distance_mm,
                                      const std::optional<TargetSighting>& target) {
  Resolver resolver(phase, calibration, distance_mm);
  resolver.Anchor(target);
  resolver.CrossBridges();
  resolver.Continue();
  resolver.DoubtNecks();
  return resolver.Take();
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
