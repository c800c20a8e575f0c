#include "reconstruct/order.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/optics.h"

namespace striae::reconstruct {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr int kEdgeRegions = 8;           ///< only the largest regions are asked for an edge
constexpr double kLargestScatter = 0.13;  ///< stripes; OPTICS measured 0.02 to 0.13 on true edges
constexpr double kLeastShare = 0.2;
constexpr int kFewestLines = 40;
constexpr double kLargestRemainder = 0.25;
constexpr double kLeastMargin = 0.4;  ///< below it a region without an anchor of its own is left out

double Median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Lines across the stripes of a PhaseResult: (line, position) is (col, row) or (row, col).
class Lines {
 public:
  explicit Lines(const PhaseResult& phase)
      : phase_(phase), horizontal_(phase.direction == StripeDirection::kHorizontal) {}
  [[nodiscard]] int count() const { return horizontal_ ? phase_.mask.width() : phase_.mask.height(); }
  [[nodiscard]] int length() const { return horizontal_ ? phase_.mask.height() : phase_.mask.width(); }
  template <typename T>
  [[nodiscard]] T At(const Image<T>& image, int line, int position) const {
    return horizontal_ ? image(line, position) : image(position, line);
  }

 private:
  const PhaseResult& phase_;
  bool horizontal_;
};

/// Median amplitude over a few periods from the end inwards: the plateau that the stripes fall from.
double Plateau(const PhaseResult& phase, const Lines& lines, int line, int end, int step) {
  std::vector<double> values;
  const int reach = static_cast<int>(4 * phase.carrier_period_px);
  for (int i = 1; i <= reach; ++i) {
    const int position = end + step * i;
    if (position < 0 || position >= lines.length()) break;
    values.push_back(lines.At(phase.amplitude, line, position));
  }
  return values.empty() ? 0 : Median(values);
}

/// Relative order where the amplitude crosses half of the plateau near the end of a run, walking outwards; nullopt
/// where the surface does not go on beyond it.
std::optional<double> EdgeOrder(const PhaseResult& phase, const Lines& lines, int line, int end, int inwards) {
  const double period = phase.carrier_period_px;
  const double plateau = Plateau(phase, lines, line, end, inwards);
  const int start = end + inwards * static_cast<int>(period);
  if (start < 0 || start >= lines.length() || plateau <= 0) return std::nullopt;
  const double order_at_start = lines.At(phase.unwrapped.phase, line, start) / kTwoPi;
  const int deeper = start + inwards * static_cast<int>(2 * period);
  if (deeper < 0 || deeper >= lines.length()) return std::nullopt;
  const double slope = (order_at_start - lines.At(phase.unwrapped.phase, line, deeper) / kTwoPi) / (start - deeper);
  if (std::isnan(order_at_start) || !std::isfinite(slope)) return std::nullopt;

  int crossing = start;
  const int furthest = start - inwards * static_cast<int>(2.5 * period);
  while (crossing >= 0 && crossing < lines.length() && crossing != furthest &&
         lines.At(phase.amplitude, line, crossing) > plateau / 2) {
    crossing -= inwards;
  }
  if (crossing < 0 || crossing >= lines.length() || crossing == furthest) return std::nullopt;
  // Linear between the two pixels around the crossing.
  const double outside = lines.At(phase.amplitude, line, crossing);
  const double inside = lines.At(phase.amplitude, line, crossing + inwards);
  const double exact = crossing + inwards * (plateau / 2 - outside) / std::max(1e-12, inside - outside);

  // Ambient light must still show the surface there: two periods on, the mean is above the dark of an empty scene.
  const int beyond = crossing - inwards * static_cast<int>(2 * period);
  if (beyond < 0 || beyond >= lines.length()) return std::nullopt;
  const double lit = lines.At(phase.background, line, start), ambient = lines.At(phase.background, line, beyond);
  if (ambient < 0.02 * lit) return std::nullopt;
  return order_at_start + slope * (exact - start);
}

/// Reduces the orders found along one end to an edge, if they are one.
std::optional<GratingEdge> JudgeEdge(std::vector<double> orders, int region_lines) {
  if (static_cast<int>(orders.size()) < kFewestLines) return std::nullopt;
  const double median = Median(orders);
  // The lines that belong to the edge: the others end at the subject's own border.
  std::vector<double> near;
  for (const double order : orders) {
    if (std::abs(order - median) < 0.5) near.push_back(order);
  }
  const double share = static_cast<double>(near.size()) / std::max(1, region_lines);
  if (static_cast<int>(near.size()) < kFewestLines || share < kLeastShare) return std::nullopt;
  const double center = Median(near);
  std::vector<double> deviations;
  for (const double order : near) deviations.push_back(std::abs(order - center));
  const double scatter = 1.4826 * Median(deviations);
  if (scatter > kLargestScatter) return std::nullopt;
  return GratingEdge{center, scatter, static_cast<int>(near.size()), share};
}

/// Median over a region's pixels of the order that a depth predicts minus the measured one.
double PredictedOffset(const PhaseResult& phase, const Calibration& calibration, const StripeOptics& optics, int region,
                       double distance_mm) {
  constexpr int kStep = 7;
  std::vector<double> offsets;
  for (int row = 0; row < phase.mask.height(); row += kStep) {
    for (int col = 0; col < phase.mask.width(); col += kStep) {
      if (phase.unwrapped.region(col, row) != region) continue;
      const auto order =
          optics.OrderAt(distance_mm * RayOf(calibration.camera, {static_cast<double>(col), static_cast<double>(row)}));
      if (order) offsets.push_back(*order - phase.unwrapped.phase(col, row) / kTwoPi);
    }
  }
  return offsets.empty() ? std::nan("") : Median(offsets);
}

std::optional<RegionOrder> FromEdges(const RegionEdges& edges, std::optional<int> stripes) {
  if (!stripes) return std::nullopt;
  std::optional<double> low, high;
  if (edges.low) low = -0.5 - edges.low->order;
  if (edges.high) high = *stripes - 0.5 - edges.high->order;
  if (!low && !high) return std::nullopt;
  RegionOrder found;
  found.source = OrderSource::kGratingEdge;
  const double offset = low && high ? (*low + *high) / 2 : (low ? *low : *high);
  found.offset = static_cast<int>(std::lround(offset));
  const double remainder = std::abs(offset - found.offset);
  found.margin = 1 - 2 * remainder;
  if (low && high && std::lround(*low) != std::lround(*high)) return std::nullopt;
  if (remainder > kLargestRemainder) return std::nullopt;
  return found;
}

/// The distance decides where only one whole number leaves the region's middle within the working range, or where one
/// is much nearer to the expected distance than the next.
RegionOrder FromDistance(const PhaseResult& phase, const Calibration& calibration, const StripeOptics& optics,
                         int region, double distance_mm) {
  const double expected = PredictedOffset(phase, calibration, optics, region, distance_mm);
  const double at_near = PredictedOffset(phase, calibration, optics, region, calibration.near_mm);
  const double at_far = PredictedOffset(phase, calibration, optics, region, calibration.far_mm);
  RegionOrder found;
  if (!std::isfinite(expected)) {
    found.warning = "nothing fixes this region's whole stripe number; it is not measured";
    return found;
  }
  found.source = OrderSource::kDistance;
  found.offset = static_cast<int>(std::lround(expected));
  found.margin = 1 - 2 * std::abs(expected - found.offset);
  const double candidates = std::abs(at_far - at_near);
  if (candidates > 1 && std::isfinite(candidates)) {
    found.margin /= candidates;
    found.warning =
        "the stripe order rests on the expected distance of " + std::to_string(std::lround(distance_mm)) +
        " mm alone, and other whole numbers fit the working range too; let the grating's edge fall on the subject, or "
        "give --distance-mm";
  }
  return found;
}

/// Depth of the regions whose order is settled, on a coarse grid of the sensor.
class CoarseDepth {
 public:
  static constexpr int kStep = 16;
  CoarseDepth(const PhaseResult& phase, const Calibration& calibration, const StripeOptics& optics)
      : phase_(phase),
        calibration_(calibration),
        optics_(optics),
        depth_(phase.mask.width() / kStep + 1, phase.mask.height() / kStep + 1, 0.0F) {}

  void Add(int region, int offset) {
    ForEachCell(region, [&](int col, int row, const Eigen::Vector3d& ray, double order) {
      if (const auto z = optics_.DepthAt(ray, order + offset)) depth_(col, row) = static_cast<float>(*z);
    });
  }

  /// Orders that a region would have if it continued the depth of what is settled around it, minus its own.
  [[nodiscard]] std::vector<double> OffsetsBeside(int region) const {
    std::vector<double> offsets;
    ForEachCell(region, [&](int col, int row, const Eigen::Vector3d& ray, double order) {
      const double around = MeanAround(col, row);
      if (around <= 0) return;
      if (const auto expected = optics_.OrderAt(around * ray)) offsets.push_back(*expected - order);
    });
    return offsets;
  }

 private:
  template <typename Visit>
  void ForEachCell(int region, const Visit& visit) const {
    for (int row = 0; row < depth_.height(); ++row) {
      for (int col = 0; col < depth_.width(); ++col) {
        const int x = col * kStep, y = row * kStep;
        if (!phase_.mask.Contains(x, y) || phase_.unwrapped.region(x, y) != region) continue;
        const Eigen::Vector3d ray = RayOf(calibration_.camera, {static_cast<double>(x), static_cast<double>(y)});
        visit(col, row, ray, phase_.unwrapped.phase(x, y) / kTwoPi);
      }
    }
  }
  [[nodiscard]] double MeanAround(int col, int row) const {
    constexpr int kReach = 6;  // about 100 px
    double sum = 0;
    int count = 0;
    for (int y = std::max(0, row - kReach); y <= std::min(depth_.height() - 1, row + kReach); ++y) {
      for (int x = std::max(0, col - kReach); x <= std::min(depth_.width() - 1, col + kReach); ++x) {
        if (depth_(x, y) <= 0) continue;
        sum += depth_(x, y);
        ++count;
      }
    }
    return count == 0 ? 0 : sum / count;
  }

  const PhaseResult& phase_;
  const Calibration& calibration_;
  const StripeOptics& optics_;
  ImageF depth_;
};

/// A region beside a settled one takes the whole number that continues its depth best.
std::optional<RegionOrder> FromNeighbours(const CoarseDepth& depth, int region) {
  std::vector<double> offsets = depth.OffsetsBeside(region);
  if (offsets.empty()) return std::nullopt;
  const double expected = Median(offsets);
  RegionOrder found;
  found.source = OrderSource::kBridge;
  found.offset = static_cast<int>(std::lround(expected));
  found.margin = 1 - 2 * std::abs(expected - found.offset);
  found.warning =
      "its whole stripe number continues the depth of the surface beside it; a step of half a stripe or more between "
      "them would go unseen";
  return found;
}

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

std::vector<RegionEdges> FindGratingEdges(const PhaseResult& phase, int regions) {
  const Lines lines(phase);
  struct Found {
    std::vector<double> low, high;
    int lines = 0;
  };
  std::vector<Found> found(static_cast<std::size_t>(regions));
  for (int line = 0; line < lines.count(); ++line) {
    // First and last pixel of every region on this line: only the outermost ends can be the grating's.
    std::vector<std::pair<int, int>> ends(static_cast<std::size_t>(regions), {-1, -1});
    for (int position = 0; position < lines.length(); ++position) {
      const int region = lines.At(phase.unwrapped.region, line, position);
      if (region < 0 || region >= regions) continue;
      auto& [first, last] = ends[static_cast<std::size_t>(region)];
      if (first < 0) first = position;
      last = position;
    }
    for (std::size_t r = 0; r < ends.size(); ++r) {
      if (ends[r].first < 0) continue;
      ++found[r].lines;
      if (const auto low = EdgeOrder(phase, lines, line, ends[r].first, +1)) found[r].low.push_back(*low);
      if (const auto high = EdgeOrder(phase, lines, line, ends[r].second, -1)) found[r].high.push_back(*high);
    }
  }
  std::vector<RegionEdges> edges;
  for (const Found& f : found) edges.push_back({JudgeEdge(f.low, f.lines), JudgeEdge(f.high, f.lines)});
  return edges;
}

std::vector<RegionOrder> ResolveOrder(const PhaseResult& phase, const Calibration& calibration, double distance_mm) {
  const StripeOptics optics(calibration);
  const int count = phase.unwrapped.regions;
  std::vector<RegionOrder> orders(static_cast<std::size_t>(count));
  for (const int region : phase.unwrapped.region.pixels()) {
    if (region >= 0) ++orders[static_cast<std::size_t>(region)].points;
  }
  const auto settle = [&](int region, RegionOrder found) {
    found.points = orders[static_cast<std::size_t>(region)].points;
    orders[static_cast<std::size_t>(region)] = std::move(found);
  };
  const auto edges = FindGratingEdges(phase, std::min(count, kEdgeRegions));
  std::vector<int> open;
  CoarseDepth depth(phase, calibration, optics);
  for (int r = 0; r < count; ++r) {
    std::optional<RegionOrder> own;
    if (r < kEdgeRegions) own = FromEdges(edges[static_cast<std::size_t>(r)], calibration.stripes);
    // The largest region must have an order: the others are then placed beside it.
    if (!own && r == 0) own = FromDistance(phase, calibration, optics, r, distance_mm);
    if (!own) {
      open.push_back(r);
      continue;
    }
    settle(r, *own);
    depth.Add(r, own->offset);
  }
  for (const int r : open) {
    auto beside = FromNeighbours(depth, r);
    if (!beside) beside = FromDistance(phase, calibration, optics, r, distance_mm);
    if (beside->margin < kLeastMargin) {
      beside->source = OrderSource::kNone;
      beside->warning = "nothing fixes this region's whole stripe number; it is left out of the surface";
    }
    settle(r, *beside);
  }
  return orders;
}

}  // namespace striae::reconstruct
