#include "reconstruct/order.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "reconstruct/detail/order_bridge.h"
#include "reconstruct/detail/order_evidence.h"
#include "reconstruct/detail/order_parting.h"

namespace striae::reconstruct {
namespace {

constexpr int kMostAnchored = 64;      ///< regions that are asked for evidence of their own
constexpr double kLeastMargin = 0.4;   ///< below it a region without an anchor of its own is left out
constexpr double kPartedMargin = 0.5;  ///< at most, of a part that follows its sheet
constexpr double kProvenMargin = 0.9;  ///< of a part between two anchors

/// +1 where shadows fall towards larger orders: the projector is on the side of the small ones.
int Away(const Calibration& calibration) {
  const Eigen::Vector3d& center = calibration.projector.center_mm;
  return (calibration.direction == StripeDirection::kHorizontal ? center.y() : center.x()) > 0 ? -1 : 1;
}

/// The regions' orders while they are being settled.
class Resolver {
 public:
  Resolver(const PhaseResult& phase, const Calibration& calibration, double distance_mm, std::vector<int> sheets = {},
           std::vector<detail::Link> links = {})
      : scene_{phase, calibration, StripeOptics(calibration)},
        distance_mm_(distance_mm),
        sheets_(std::move(sheets)),
        links_(std::move(links)),
        away_(Away(calibration)),
        count_(phase.unwrapped.regions),
        asked_(std::min(count_, kMostAnchored)),
        orders_(static_cast<std::size_t>(count_)),
        settled_(static_cast<std::size_t>(count_), false),
        bounds_(static_cast<std::size_t>(count_)),
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

  /// Where light goes on away from the projector nothing falls back; so what lies between two anchors with one number
  /// has it too.
  void Squeeze() {
    for (std::size_t r = 0; r < orders_.size(); ++r) {
      if (settled_[r] && orders_[r].warning.empty()) bounds_[r] = {orders_[r].offset, orders_[r].offset};
    }
    while (Tighten()) {
    }
    for (int r = 0; r < count_; ++r) {
      const auto i = static_cast<std::size_t>(r);
      if (settled_[i] || bounds_[i].least != bounds_[i].most) continue;
      RegionOrder found;
      found.source = OrderSource::kBridge;
      found.offset = bounds_[i].least;
      found.margin = kProvenMargin;
      Settle(r, std::move(found));
    }
  }

  /// What has no anchor, always with a warning: beside what is settled, step by step; the largest region from the
  /// distance when nothing is.
  void Continue() {
    GoOnFromSettled();
    for (int r = 0; r < count_; ++r) {
      if (settled_[static_cast<std::size_t>(r)]) continue;
      std::optional<RegionOrder> found = FromSheet(r);
      const bool is_relative = found.has_value();
      if (r > 0 && !found) found = depth_.Continued(r);
      if (!found && r < asked_)
        found = detail::FromDistance(scene_, samples_[static_cast<std::size_t>(r)], distance_mm_);
      if (r > 0 && !is_relative && (!found || found->margin < kLeastMargin)) {
        found = RegionOrder{};
        found->warning = "nothing fixes this region's whole stripe number; it is left out of the surface";
      }
      Settle(r, *std::move(found));
      GoOnFromSettled();
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

  /// Across shadows first, then along most light, so that a face goes on from its chin and not from the chest that the
  /// unwrapping joined it to.
  void GoOnFromSettled() {
    for (bool changed = true; changed;) {
      changed = false;
      for (int r = 0; r < count_; ++r) {
        if (settled_[static_cast<std::size_t>(r)]) continue;
        if (auto found = FromShadow(r)) {
          Settle(r, *std::move(found));
          changed = true;
        }
      }
      if (!changed) changed = GoOnAlongMostLight();
    }
  }

  /// Settles the region into which most lines of light go on from a settled part of its sheet; false where there is
  /// none.
  bool GoOnAlongMostLight() {
    constexpr std::size_t kFewestLines = 3;
    std::size_t most = kFewestLines - 1;
    int from = -1, to = -1;
    for (const detail::Link& link : links_) {
      const auto a = static_cast<std::size_t>(link.from), b = static_cast<std::size_t>(link.to);
      if (settled_[a] == settled_[b] || !OneSheet(a, b) || link.lines.lit <= std::max(most, link.lines.unlit)) continue;
      if (orders_[settled_[a] ? a : b].source == OrderSource::kNone) continue;
      most = link.lines.lit;
      std::tie(from, to) = settled_[a] ? std::pair(link.from, link.to) : std::pair(link.to, link.from);
    }
    if (from >= 0) Settle(to, GoneOn(from, to));
    return from >= 0;
  }

  /// The number of a settled part of its sheet, within the bounds that the light sets.
  [[nodiscard]] RegionOrder GoneOn(int from, int to) const {
    const auto r = static_cast<std::size_t>(from), own = static_cast<std::size_t>(to);
    RegionOrder found;
    found.source = OrderSource::kBridge;
    found.offset = std::clamp(orders_[r].offset, bounds_[own].least, std::max(bounds_[own].least, bounds_[own].most));
    found.margin = std::min(kPartedMargin, orders_[r].margin);
    found.warning =
        "the stripes are dimmed or bent where it joins the rest, or it hangs on it by a narrow neck: its whole stripe "
        "number goes on from there, and a step of whole stripes in depth would go unseen";
    return found;
  }

  /// From the largest settled part of its sheet, when light goes on into none.
  [[nodiscard]] std::optional<RegionOrder> FromSheet(int region) const {
    const auto own = static_cast<std::size_t>(region);
    for (std::size_t r = 0; r < orders_.size(); ++r) {
      if (r == own || !settled_[r] || !OneSheet(r, own) || orders_[r].source == OrderSource::kNone) continue;
      return GoneOn(static_cast<int>(r), region);
    }
    return std::nullopt;
  }

  /// The number that a shadow between it and a settled region gives: the sheet of light at the shadow's end is the one
  /// that passes the edge which casts it.
  [[nodiscard]] std::optional<RegionOrder> FromShadow(int region) const {
    std::optional<RegionOrder> found;
    std::size_t largest = 0;
    for (const detail::Link& link : links_) {
      if (!link.shadow || (link.from != region && link.to != region)) continue;
      const auto other = static_cast<std::size_t>(link.from == region ? link.to : link.from);
      if (!settled_[other] || orders_[other].source == OrderSource::kNone || orders_[other].points < largest) continue;
      largest = orders_[other].points;
      found.emplace();
      found->source = OrderSource::kBridge;
      found->offset = orders_[other].offset + (link.from == region ? -link.step : link.step);
      found->margin = std::min(orders_[other].margin, 2 * link.alike - 1);
      found->warning =
          "its whole stripe number rests on the shadow between it and the surface beside it; where that is no shadow "
          "but dark cloth or empty space, the number is wrong";
    }
    return found;
  }

  /// A part's light may go on into several others, each along too few lines to prove anything: together they do, for
  /// the weakest of their bounds. Whether any bound changed.
  bool Tighten() {
    struct Word {
      int bound;
      detail::LitLines lines;
    };
    std::vector<std::vector<Word>> at_most(orders_.size()), at_least(orders_.size());
    for (const detail::Link& link : links_) {
      const auto from = static_cast<std::size_t>(link.from), to = static_cast<std::size_t>(link.to);
      if (link.lines.lit + link.lines.unlit == 0 || !OneSheet(from, to)) continue;
      // Nearer is the larger order where shadows fall towards larger orders.
      const auto [less, more] = away_ > 0 ? std::pair(from, to) : std::pair(to, from);
      if (bounds_[more].most != Bounds{}.most) at_most[less].push_back({bounds_[more].most, link.lines});
      if (bounds_[less].least != Bounds{}.least) at_least[more].push_back({bounds_[less].least, link.lines});
    }
    bool changed = false;
    for (std::size_t r = 0; r < orders_.size(); ++r) {
      std::stable_sort(at_most[r].begin(), at_most[r].end(),
                       [](const Word& a, const Word& b) { return a.bound < b.bound; });
      std::stable_sort(at_least[r].begin(), at_least[r].end(),
                       [](const Word& a, const Word& b) { return a.bound > b.bound; });
      detail::LitLines sum;
      for (const Word& word : at_most[r]) {
        if (word.bound >= bounds_[r].most) break;
        sum += word.lines;
        if (sum.Proven()) bounds_[r].most = word.bound, changed = true;
      }
      sum = {};
      for (const Word& word : at_least[r]) {
        if (word.bound <= bounds_[r].least) break;
        sum += word.lines;
        if (sum.Proven()) bounds_[r].least = word.bound, changed = true;
      }
    }
    return changed;
  }

  struct Bounds {
    int least = std::numeric_limits<int>::min(), most = std::numeric_limits<int>::max();
  };

  detail::OrderScene scene_;
  double distance_mm_;
  std::vector<int> sheets_;
  std::vector<detail::Link> links_;
  int away_, count_, asked_;
  std::vector<RegionOrder> orders_;
  std::vector<bool> settled_;
  std::vector<Bounds> bounds_;
  detail::CoarseDepth depth_;
  std::vector<std::vector<detail::RegionSample>> samples_;
};

}  // namespace

std::vector<RegionOrder> ResolveOrder(const PhaseResult& phase, const Calibration& calibration, double distance_mm,
                                      const std::optional<TargetSighting>& target) {
  Resolver resolver(phase, calibration, distance_mm);
  resolver.Anchor(target);
  resolver.Continue();
  return resolver.Take();
}

std::vector<RegionOrder> SettleOrder(PhaseResult& phase, const ImageRgb& picture, const Calibration& calibration,
                                     double distance_mm, const std::optional<TargetSighting>& target) {
  detail::Parting parting(phase, picture, Away(calibration));
  parting.Part(phase);
  Resolver resolver(phase, calibration, distance_mm, parting.sheets(), parting.links());
  resolver.Anchor(target);
  resolver.Squeeze();
  resolver.Continue();
  auto orders = resolver.Take();
  parting.Join(phase, orders);
  return orders;
}

}  // namespace striae::reconstruct
