#include "acquire/rig/detail/limb_truth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace striae::rig::detail {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kRings = 400, kSectors = 720;  // midpoint rule in polar coordinates: relative error below 1e-5
constexpr int kOutlinePoints = 120;

/// Outline radius relative to the ellipse in a direction (of the coordinates scaled to a circle).
double OutlineFactor(const CraterOptions& c, double direction) {
  return 1 + c.irregularity * std::cos(3 * direction + 0.7);
}

double CentreRadius(const LimbOptions& o) { return LimbRadius(o, o.crater.angle_deg * kPi / 180, o.crater.along_mm); }

struct Place {
  double angle = 0, along = 0;
};

Place PlaceOf(const LimbOptions& o, double rho, double direction, double centre_radius) {
  const CraterOptions& c = o.crater;
  const double scaled = rho * OutlineFactor(c, direction) * c.radius_mm;
  return {c.angle_deg * kPi / 180 + scaled * std::cos(direction) / centre_radius,
          c.along_mm + scaled * std::sin(direction) * c.elongation};
}

/// Area of the surface radius(angle, along) over d angle d along: |P_angle x P_along|.
template <typename Radius>
double AreaDensity(const Radius& radius, const Place& p) {
  constexpr double kStep = 1e-4;
  const double r = radius(p.angle, p.along);
  const double r_angle = (radius(p.angle + kStep, p.along) - radius(p.angle - kStep, p.along)) / (2 * kStep);
  const double r_along = (radius(p.angle, p.along + kStep) - radius(p.angle, p.along - kStep)) / (2 * kStep);
  return std::sqrt(r * r * (1 + r_along * r_along) + r_angle * r_angle);
}

/// Distance from the bed's deepest point to the healthy skin, by a search around it.
double LargestDepth(const LimbOptions& o) {
  const double angle = o.crater.angle_deg * kPi / 180;
  const Eigen::Vector3d deepest =
      LimbPoint(angle, o.crater.along_mm, LimbRadius(o, angle, o.crater.along_mm) - o.crater.depth_mm);
  double best = std::numeric_limits<double>::infinity(), best_angle = angle, best_along = o.crater.along_mm;
  for (double step = 1; step > 1e-4; step /= 2) {
    const double from_angle = best_angle, from_along = best_along;
    for (int i = -4; i <= 4; ++i) {
      for (int j = -4; j <= 4; ++j) {
        const double a = from_angle + i * step / o.radius_mm, s = from_along + j * step;
        const double distance = (LimbPoint(a, s, LimbRadius(o, a, s)) - deepest).norm();
        if (distance < best) {
          best = distance;
          best_angle = a;
          best_along = s;
        }
      }
    }
  }
  return best;
}

}  // namespace

double CraterRho(const LimbOptions& o, double angle, double along) {
  const CraterOptions& c = o.crater;
  const double u = CentreRadius(o) * (angle - c.angle_deg * kPi / 180) / c.radius_mm;
  const double v = (along - c.along_mm) / (c.radius_mm * c.elongation);
  return std::hypot(u, v) / OutlineFactor(c, std::atan2(v, u));
}

Eigen::Vector3d LimbPoint(double angle, double along, double radius) {
  return {radius * std::sin(angle), along, -radius * std::cos(angle)};
}

WoundTruth IntegrateWound(const LimbOptions& o) {
  const CraterOptions& c = o.crater;
  const double centre_radius = CentreRadius(o);
  const auto skin = [&o](double a, double s) { return LimbRadius(o, a, s); };
  const auto bed = [&o](double a, double s) { return LimbRadius(o, a, s) - CraterDepth(o, a, s); };
  double volume = 0, skin_area = 0, bed_area = 0;
  for (int sector = 0; sector < kSectors; ++sector) {
    const double direction = 2 * kPi * (sector + 0.5) / kSectors;
    const double factor = OutlineFactor(c, direction) * c.radius_mm;
    for (int ring = 0; ring < kRings; ++ring) {
      const double rho = (ring + 0.5) / kRings;
      const Place p = PlaceOf(o, rho, direction, centre_radius);
      // d angle d along = (factor^2 elongation / centre_radius) rho d rho d direction
      const double cell = factor * factor * c.elongation / centre_radius * rho / kRings * (2 * kPi / kSectors);
      const double outer = skin(p.angle, p.along), inner = bed(p.angle, p.along);
      volume += cell * (outer * outer - inner * inner) / 2;  // of a wedge between two radii
      skin_area += cell * AreaDensity(skin, p);
      bed_area += cell * AreaDensity(bed, p);
    }
  }
  WoundTruth truth{volume / 1000, skin_area / 100, bed_area / 100, LargestDepth(o), {}};
  for (int i = 0; i < kOutlinePoints; ++i) {
    const Place p = PlaceOf(o, 1, 2 * kPi * i / kOutlinePoints, centre_radius);
    truth.outline_in_camera.push_back(LimbPoint(p.angle, p.along, skin(p.angle, p.along)));
  }
  return truth;
}

}  // namespace striae::rig::detail
