#include "analysis/wound/detail/ring.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace striae::wound {
namespace {

constexpr std::size_t kMostPoints = 40000;  // more changes no digit that matters, and fitting is linear in it
constexpr int kSectors = 36, kTrendSectors = 24;
constexpr double kSectorFilled = 0.3;

int SectorOf(double along, int sectors) { return std::min(sectors - 1, static_cast<int>(along * sectors)); }

// Medians, so that hair does not pass for swelling.
double Median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Compares occupied squares of the frame's plane with those that the whole ring would occupy.
void MeasureCoverage(const Scene& scene, Ring& ring, const std::vector<Eigen::Vector3d>& all) {
  const double square = std::max(ring.width_mm / 12, 2 * scene.patch.cell_mm());
  const auto key = [&](double x) { return static_cast<int>(std::floor(x / square)); };
  std::set<std::pair<int, int>> occupied;
  for (const auto& p : all) occupied.emplace(key(p.x()), key(p.y()));

  const PolygonField field(Resample(scene.outline, 2 * square));
  Eigen::Vector2d low = scene.outline.front(), high = low;
  for (const auto& p : scene.outline) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double reach = ring.gap_mm + ring.width_mm;
  std::array<double, kSectors> expected{}, found{};
  double expected_sum = 0, found_sum = 0;
  for (int b = key(low.y() - reach); b <= key(high.y() + reach); ++b) {
    for (int a = key(low.x() - reach); a <= key(high.x() + reach); ++a) {
      const auto place = field.At({(a + 0.5) * square, (b + 0.5) * square});
      if (place.distance < ring.gap_mm || place.distance > reach) continue;
      const auto sector = static_cast<std::size_t>(SectorOf(place.along, kSectors));
      const double here = occupied.contains({a, b}) ? 1 : 0;
      ++expected[sector];
      ++expected_sum;
      found[sector] += here;
      found_sum += here;
    }
  }
  ring.coverage = expected_sum > 0 ? found_sum / expected_sum : 0;
  int empty = 0;
  for (std::size_t s = 0; s < kSectors; ++s) empty += found[s] < kSectorFilled * expected[s] ? 1 : 0;
  ring.empty_sectors = static_cast<double>(empty) / kSectors;
}

}  // namespace

Ring TakeRing(const Scene& scene, double gap_mm, double width_mm) {
  Ring ring;
  ring.gap_mm = gap_mm;
  ring.width_mm = width_mm;
  std::vector<Eigen::Vector3d> points;
  std::vector<PolygonPlace> places;
  for (std::size_t cell = 0; cell < scene.patch.size(); ++cell) {
    const auto& place = scene.place[cell];
    if (scene.patch.state[cell] != Patch::kMeasured || place.distance < gap_mm || place.distance > gap_mm + width_mm) {
      continue;
    }
    points.push_back(scene.local[cell]);
    places.push_back(place);
  }
  MeasureCoverage(scene, ring, points);
  const std::size_t stride = (points.size() + kMostPoints - 1) / kMostPoints;
  for (std::size_t k = 0; k < points.size(); k += std::max<std::size_t>(1, stride)) {
    ring.points.push_back(points[k]);
    ring.places.push_back(places[k]);
  }
  return ring;
}

RadialTrend FindRadialTrend(const Ring& ring, const Skin& skin) {
  std::array<std::vector<double>, kTrendSectors> inner, middle;
  for (std::size_t k = 0; k < ring.points.size(); ++k) {
    const auto& p = ring.points[k];
    const double depth_in_ring = (ring.places[k].distance - ring.gap_mm) / ring.width_mm;
    if (depth_in_ring > 0.5) continue;
    const auto sector = static_cast<std::size_t>(SectorOf(ring.places[k].along, kTrendSectors));
    (depth_in_ring < 1.0 / 6 ? inner : middle)[sector].push_back(p.z() - skin.Height(p.x(), p.y()));
  }
  std::vector<double> steps;
  for (std::size_t s = 0; s < kTrendSectors; ++s) {
    if (!inner[s].empty() && !middle[s].empty()) steps.push_back(Median(inner[s]) - Median(middle[s]));
  }
  if (steps.size() < kTrendSectors / 2) return {};
  double mean = 0, square = 0;
  for (const double step : steps) mean += step / static_cast<double>(steps.size());
  for (const double step : steps) square += (step - mean) * (step - mean);
  const double count = static_cast<double>(steps.size());
  const double standard_error = std::sqrt(square / (count - 1) / count);
  return {mean, standard_error > 0 ? mean / standard_error : 0};
}

double SteepShare(const Ring& ring, const Skin& skin, double max_slope_deg) {
  const double limit = std::tan(max_slope_deg * M_PI / 180);
  const std::size_t stride = std::max<std::size_t>(1, ring.points.size() / 2000);
  double steep = 0, count = 0;
  for (std::size_t k = 0; k < ring.points.size(); k += stride) {
    ++count;
    if (skin.Gradient(ring.points[k].x(), ring.points[k].y()).norm() > limit) ++steep;
  }
  return count > 0 ? steep / count : 1;
}

}  // namespace striae::wound
