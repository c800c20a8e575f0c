#include "analysis/wound/detail/quantities.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "analysis/wound/detail/line.h"

namespace striae::wound {
namespace {

// The greatest of many depths is one that errs by much: it is sought among depths less twice their standard
// uncertainties, which grow beside shadows and steep walls.
constexpr double kSure = 2;

// One pass of a normalised Gaussian along rows (stride 1) or columns (stride width).
void SmoothAlong(const Patch& patch, double sd_cells, bool rows, std::vector<double>& sum, std::vector<double>& mass) {
  const int radius = static_cast<int>(std::ceil(3 * sd_cells));
  std::vector<double> kernel(static_cast<std::size_t>(radius) + 1);
  for (int k = 0; k <= radius; ++k) kernel[static_cast<std::size_t>(k)] = std::exp(-k * k / (2 * sd_cells * sd_cells));
  std::vector<double> sum_out(sum.size(), 0), mass_out(mass.size(), 0);
  for (int j = 0; j < patch.height; ++j) {
    for (int i = 0; i < patch.width; ++i) {
      double s = 0, m = 0;
      for (int k = -radius; k <= radius; ++k) {
        const int a = rows ? i + k : i, b = rows ? j : j + k;
        if (a < 0 || b < 0 || a >= patch.width || b >= patch.height) continue;
        const double weight = kernel[static_cast<std::size_t>(std::abs(k))];
        s += weight * sum[patch.At(a, b)];
        m += weight * mass[patch.At(a, b)];
      }
      sum_out[patch.At(i, j)] = s;
      mass_out[patch.At(i, j)] = m;
    }
  }
  sum = std::move(sum_out);
  mass = std::move(mass_out);
}

double Percentile95(std::vector<std::pair<double, double>> value_and_area) {
  std::sort(value_and_area.begin(), value_and_area.end());
  double total = 0;
  for (const auto& entry : value_and_area) total += entry.second;
  double below = 0;
  for (const auto& [value, area] : value_and_area) {
    below += area;
    if (below >= 0.95 * total) return value;
  }
  return 0;
}

}  // namespace

double NormalDepth(const Skin& skin, const Eigen::Vector3d& p) {
  // The foot f of the normal through p obeys p = f - depth n(f): repeated substitution contracts while the depth is
  // below the radius of curvature.
  Eigen::Vector2d foot = p.head<2>();
  double depth = 0;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d g = skin.Gradient(foot.x(), foot.y());
    const Eigen::Vector3d normal = Eigen::Vector3d(-g.x(), -g.y(), 1).normalized();
    depth = normal.dot(Eigen::Vector3d(foot.x(), foot.y(), skin.Height(foot.x(), foot.y())) - p);
    foot = p.head<2>() + depth * normal.head<2>();
  }
  return depth;
}

std::vector<double> SmoothedHeights(const Scene& scene, const Skin& skin, double smoothing_mm, double reach_mm) {
  std::vector<double> sum(scene.patch.size(), 0), mass(scene.patch.size(), 0);
  for (std::size_t cell = 0; cell < sum.size(); ++cell) {
    if (!(scene.place[cell].distance <= reach_mm)) continue;
    const auto& p = scene.local[cell];
    sum[cell] = skin.Height(p.x(), p.y()) - p.z();
    mass[cell] = 1;
  }
  const double sd_cells = smoothing_mm / scene.patch.cell_mm();
  if (sd_cells > 0.3) {  // less does not reach the neighbouring cell
    SmoothAlong(scene.patch, sd_cells, true, sum, mass);
    SmoothAlong(scene.patch, sd_cells, false, sum, mass);
  }
  for (std::size_t cell = 0; cell < sum.size(); ++cell) sum[cell] = mass[cell] > 0 ? sum[cell] / mass[cell] : 0;
  return sum;
}

Depths MeasureDepths(const Scene& scene, const Bed& bed, const Skin& skin, const std::vector<double>& smoothed,
                     double proud_threshold_mm) {
  Depths depths;
  std::vector<double> depth(bed.cell.size()), height(bed.cell.size());
  Bed smooth = bed;
  double surely_deepest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < bed.cell.size(); ++k) {
    auto& p = smooth.point[k];
    height[k] = smoothed[bed.cell[k]];
    p.z() = skin.Height(p.x(), p.y()) - height[k];
    depth[k] = NormalDepth(skin, p);
    const std::size_t cell = bed.cell[k];
    const double surely = depth[k] - kSure * scene.patch.UncertaintyMm(cell);
    if (bed.distance[k] <= 0 && scene.patch.state[cell] == Patch::kMeasured && surely > surely_deepest) {
      surely_deepest = surely;
      depths.max_mm = std::max(0.0, depth[k]);
      depths.deepest = p.head<2>();
    }
  }
  double plane_area = 0;
  std::vector<std::pair<double, double>> by_depth;
  for (const auto& t : bed.triangles) {
    const double area = SignedPlaneArea(bed, t);
    double proud = 0;
    for (const auto v : t) proud += height[v] < -proud_threshold_mm ? -height[v] * area / 3 : 0;
    depths.proud_all_mm3 += proud;
    const bool bridged =
        std::any_of(t.begin(), t.end(), [&](auto v) { return scene.patch.state[bed.cell[v]] == Patch::kFilled; });
    if (bridged) depths.bridged_mm3 += area * std::abs(height[t[0]] + height[t[1]] + height[t[2]]) / 3;
    if (bed.distance[t[0]] + bed.distance[t[1]] + bed.distance[t[2]] > 0) continue;
    depths.proud_mm3 += proud;
    const Eigen::Vector3d ab = smooth.point[t[1]] - smooth.point[t[0]], ac = smooth.point[t[2]] - smooth.point[t[0]];
    depths.bed_area_mm2 += ab.cross(ac).norm() / 2;
    plane_area += area;
    by_depth.emplace_back((depth[t[0]] + depth[t[1]] + depth[t[2]]) / 3, std::max(0.0, area));
  }
  depths.p95_mm = std::max(0.0, Percentile95(std::move(by_depth)));
  // Cells follow the outline in steps: the share of area that they miss or add is corrected in the plane.
  if (plane_area > 0) depths.bed_area_mm2 *= EnclosedArea(scene.outline) / plane_area;
  return depths;
}

Boundary MeasureBoundary(const Polygon& outline, const Skin& skin, double step_mm, double cell_mm,
                         double smoothing_mm) {
  Boundary boundary;
  boundary.plane_area_mm2 = EnclosedArea(outline);
  IntegrateOver(outline, cell_mm, [&](const Eigen::Vector2d& p, double area) {
    boundary.area_mm2 += area * std::sqrt(1 + skin.Gradient(p.x(), p.y()).squaredNorm());
  });
  std::vector<Eigen::Vector3d> draped;
  // A shaky line is longer than what it goes around: the smoothing is meant along the latter.
  const Polygon even = Resample(outline, step_mm);
  const double drawn_mm = PolygonField(even).perimeter();
  Polygon line = even;
  for (int round = 0; round < 4; ++round) {
    line = Smoothed(even, smoothing_mm * drawn_mm / PolygonField(line).perimeter());
  }
  for (const auto& p : line) draped.emplace_back(p.x(), p.y(), skin.Height(p.x(), p.y()));
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  for (std::size_t a = 0; a < draped.size(); ++a) {
    boundary.perimeter_mm += (draped[(a + 1) % draped.size()] - draped[a]).norm();
    for (std::size_t b = a + 1; b < draped.size(); ++b) {
      const double chord = (draped[b] - draped[a]).norm();
      if (chord <= boundary.length_mm) continue;
      boundary.length_mm = chord;
      axis = (draped[b] - draped[a]) / chord;
      boundary.axis_from = draped[a].head<2>();
      boundary.axis_to = draped[b].head<2>();
    }
  }
  // Across: perpendicular to the chord, square to the mean normal of the outline.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
  for (const auto& p : draped) centre += p / static_cast<double>(draped.size());
  for (std::size_t k = 0; k < draped.size(); ++k) {
    normal += (draped[k] - centre).cross(draped[(k + 1) % draped.size()] - centre);
  }
  const Eigen::Vector3d across = normal.cross(axis).normalized();
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& p : draped) {
    low = std::min(low, p.dot(across));
    high = std::max(high, p.dot(across));
  }
  boundary.width_mm = high - low;
  return boundary;
}

}  // namespace striae::wound
