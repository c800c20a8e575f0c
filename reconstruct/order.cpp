#include "reconstruct/order.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "reconstruct/detail/order_bridge.h"
#include "reconstruct/detail/order_evidence.h"

namespace striae::reconstruct {
namespace {

constexpr int kMostAnchored = 64;      ///< regions that are asked for evidence of their own
constexpr double kLeastMargin = 0.4;   ///< below it a region without an anchor of its own is left out
constexpr double kPartedMargin = 0.5;  ///< at most, of a part that follows its sheet

/// The regions' orders while they are being settled.
class Resolver {
 public:
  Resolver(const PhaseResult& phase, const Calibration& calibration, double distance_mm, std::vector<int> sheets)
      : scene_{phase, calibration, StripeOptics(calibration)},
        distance_mm_(distance_mm),
        sheets_(std::move(sheets)),
        count_(phase.unwrapped.regions),
        asked_(std::min(count_, kMostAnchored)),
        orders_(static_cast<std::size_t>(count_)),
        settled_(static_cast<std::size_t>(count_), false),
        depth_(scene_) {
    for (std::size_t r = 0; r < orders_.size(); ++r) orders_[r].points = phase.unwrapped.pixels.at(r);
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

  /// What has no anchor, always with a warning: the largest region from the distance when nothing is settled, the
  /// others beside what is.
  void Continue() {
    for (int r = 0; r < count_; ++r) {
      if (settled_[static_cast<std::size_t>(r)]) continue;
      std::optional<RegionOrder> found;
      if (r > 0) found = FromSheet(r);
      if (r > 0 && !found) found = depth_.Continued(r);
      if (!found && r < asked_)
        found = detail::FromDistance(scene_, samples_[static_cast<std::size_t>(r)], distance_mm_);
      if (r > 0 && (!found || found->margin < kLeastMargin)) {
        found = RegionOrder{};
        found->warning = "nothing fixes this region's whole stripe number; it is left out of the surface";
      }
      Settle(r, *std::move(found));
    }
  }

  /// Regions with a shadow inside that something before them may cast.
  void DoubtShadows() {
    constexpr int kFewestLines = 8;
    const auto lines = detail::ShadowedLines(scene_.phase, asked_);
    for (std::size_t r = 0; r < lines.size(); ++r) {
      if (lines[r] < kFewestLines || !orders_[r].warning.empty()) continue;
      orders_[r].warning =
          "a shadow as wide as a stripe or more falls on it: what casts it, and is joined to it, may be off by whole "
          "stripes; look for steps in depth that should not be there";
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

  [[nodiscard]] bool OneSheet(std::size_t a, std::size_t b) const {
    return a < sheets_.size() && b < sheets_.size() && sheets_[a] == sheets_[b];
  }

  /// The number of the largest settled region that it was one sheet with.
  [[nodiscard]] std::optional<RegionOrder> FromSheet(int region) const {
    const auto own = static_cast<std::size_t>(region);
    for (std::size_t r = 0; r < orders_.size(); ++r) {
      if (r == own || !settled_[r] || !OneSheet(r, own) || orders_[r].source == OrderSource::kNone) continue;
      RegionOrder found;
      found.source = OrderSource::kBridge;
      found.offset = orders_[r].offset;
      found.margin = std::min(kPartedMargin, orders_[r].margin);
      found.warning =
          "the stripes are dimmed all along where it joins the rest, or it hangs on it by a narrow neck: its whole "
          "stripe number goes on from there, and a step of whole stripes in depth would go unseen";
      return found;
    }
    return std::nullopt;
  }

  detail::OrderScene scene_;
  double distance_mm_;
  std::vector<int> sheets_;
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
                                      const std::optional<TargetSighting>& target, const std::vector<int>& sheets) {
  Resolver resolver(phase, calibration, distance_mm, sheets);
  resolver.Anchor(target);
  resolver.Continue();
  resolver.DoubtShadows();
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
