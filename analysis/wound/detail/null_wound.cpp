#include "analysis/wound/detail/null_wound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "analysis/wound/detail/quantities.h"

namespace striae::wound {
namespace {

constexpr int kDirections = 8;
constexpr double kStep = 2;     // mm between tried distances
constexpr double kClear = 1.5;  // mm between the wound's skin that is left out and the moved outline
constexpr double kLeastCoverage = 0.7, kMostEmptySectors = 0.2, kLeastInside = 0.97, kMostSteep = 0.1,
                 kMostOutliers = 0.15;

struct Circle {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0;
};

Circle Around(const Polygon& outline) {
  Circle circle;
  for (const auto& p : outline) circle.centre += p / static_cast<double>(outline.size());
  for (const auto& p : outline) circle.radius = std::max(circle.radius, (p - circle.centre).norm());
  return circle;
}

// The nearest shift in a direction that keeps the moved outline off the wound's own skin.
double ShiftFor(const Polygon& outline, const PolygonField& field, const Eigen::Vector2d& way, double clear_mm) {
  for (double shift = kStep;; shift += kStep) {
    const bool free = std::all_of(outline.begin(), outline.end(),
                                  [&](const auto& p) { return field.At(p + shift * way).distance > clear_mm; });
    if (free) return shift;
  }
}

// Puts the outline's middle on the skin at a place of the wound's plane and takes the plane of the skin there, turned
// so that the outline keeps its direction on the body. False where nothing is.
bool LayDown(const Scene& coarse, const std::vector<std::uint8_t>& healthy, const Circle& wound,
             const Eigen::Vector2d& to, double reach_mm, Scene& moved) {
  double nearest = std::numeric_limits<double>::infinity();
  std::size_t middle = 0;
  for (std::size_t c = 0; c < healthy.size(); ++c) {
    if (healthy[c] == 0) continue;
    const double distance = (coarse.local[c].head<2>() - to).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    middle = c;
  }
  if (nearest > 2 * coarse.patch.cell_mm()) return false;
  const Eigen::Vector3d centre = coarse.patch.point[middle];
  std::vector<Eigen::Vector3d> around;
  for (std::size_t c = 0; c < healthy.size(); ++c) {
    if (healthy[c] != 0 && (coarse.patch.point[c] - centre).norm() < reach_mm) around.push_back(coarse.patch.point[c]);
  }
  if (around.size() < 100) return false;
  moved.frame = FitFrame(around);
  const Eigen::Vector3d w = moved.frame.wound_from_camera.row(2);
  const Eigen::Vector3d u_before = coarse.frame.wound_from_camera.row(0);
  const Eigen::Vector3d u = (u_before - u_before.dot(w) * w).normalized();
  moved.frame.wound_from_camera << u.transpose(), w.cross(u).transpose(), w.transpose();
  const Eigen::Vector2d place = moved.frame.FromCamera(centre).head<2>();
  moved.outline.clear();
  for (const auto& p : coarse.outline) moved.outline.push_back(p - wound.centre + place);
  return true;
}

void PlaceCells(const Scene& coarse, const std::vector<std::uint8_t>& healthy, double reach_mm, Scene& moved) {
  const PolygonField field(moved.outline);
  const Circle circle = Around(moved.outline);
  moved.place.assign(coarse.patch.size(), {std::numeric_limits<double>::infinity(), 0});
  moved.local.assign(coarse.patch.size(), Eigen::Vector3d::Zero());
  for (std::size_t c = 0; c < healthy.size(); ++c) {
    if (healthy[c] == 0) continue;
    moved.local[c] = moved.frame.FromCamera(coarse.patch.point[c]);
    if ((moved.local[c].head<2>() - circle.centre).norm() > circle.radius + reach_mm) continue;
    moved.place[c] = field.At(moved.local[c].head<2>());
  }
}

std::optional<NullWound> MeasureNull(const Scene& moved, double gap_mm, double width_mm, double max_slope_deg) {
  const Ring ring = TakeRing(moved, gap_mm, width_mm);
  if (ring.points.size() < 100 || ring.coverage < kLeastCoverage || ring.empty_sectors > kMostEmptySectors) {
    return std::nullopt;
  }
  const RingWeights weights = WeighRing(ring.points);
  if (weights.outlier_share > kMostOutliers) return std::nullopt;
  const Bed bed = TakeBed(moved, 0);
  double plane_area = PrismSum(bed, std::vector<double>(bed.point.size(), 1));
  if (plane_area < kLeastInside * EnclosedArea(moved.outline)) return std::nullopt;
  NullWound null;
  for (std::size_t m = 0; m < kSkinModels.size(); ++m) {
    const Skin skin = FitSkin(kSkinModels[m], ring.points, weights);
    if (m == 0 && SteepShare(ring, skin, max_slope_deg) > kMostSteep) return std::nullopt;
    if (skin.fell_back && m > 0) continue;
    const auto heights = HeightsAbove(bed, skin);
    null.mean_mm[m] = PrismSum(bed, heights) / plane_area;
    if (m > 0) continue;
    for (const double h : heights) null.deepest_mm = std::max(null.deepest_mm, std::abs(h));
  }
  return null;
}

}  // namespace

std::optional<double> IntactSkin::Rms(std::size_t model, std::size_t least) const {
  double squares = 0, count = 0;
  for (const NullWound& null : wounds) {
    if (!null.mean_mm[model]) continue;
    squares += *null.mean_mm[model] * *null.mean_mm[model];
    ++count;
  }
  if (count < std::max<double>(1, static_cast<double>(least))) return std::nullopt;
  return std::sqrt(squares / count);
}

IntactSkin TryIntactSkin(const Scene& coarse, double gap_mm, double ring_width_mm, double max_slope_deg) {
  IntactSkin intact;
  const Circle wound = Around(coarse.outline);
  const PolygonField field(coarse.outline);
  std::vector<std::uint8_t> healthy(coarse.patch.size());
  for (std::size_t c = 0; c < healthy.size(); ++c) {
    healthy[c] =
        coarse.patch.state[c] == Patch::kMeasured && coarse.place[c].distance < 1e9 && coarse.place[c].distance > gap_mm
            ? 1
            : 0;
  }
  const double reach_mm = gap_mm + ring_width_mm;
  for (int d = 0; d < kDirections; ++d) {
    const double angle = 2 * M_PI * d / kDirections;
    const Eigen::Vector2d way(std::cos(angle), std::sin(angle));
    const double shift = ShiftFor(coarse.outline, field, way, gap_mm + kClear);
    Scene moved;
    if (!LayDown(coarse, healthy, wound, wound.centre + shift * way, wound.radius + reach_mm / 2, moved)) continue;
    moved.patch = coarse.patch;
    PlaceCells(coarse, healthy, reach_mm, moved);
    auto null = MeasureNull(moved, gap_mm, ring_width_mm, max_slope_deg);
    if (!null) continue;
    null->shift_mm = shift * way;
    intact.wounds.push_back(*std::move(null));
  }
  return intact;
}

}  // namespace striae::wound
