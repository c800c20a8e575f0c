#include "acquire/rig/limb.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquire/rig/detail/limb_truth.h"
#include "acquire/rig/detail/texture.h"

namespace striae::rig {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFine_mm = 0.2;    // in the crater: facets deviate by under 0.01 mm at its rim's curvature of 2 / mm
constexpr double kCoarse_mm = 1.2;  // elsewhere: chord error 1.2^2 / (8 * 50) = 0.004 mm
const Eigen::Vector3d kSkin(0.56, 0.36, 0.27), kBed(0.46, 0.15, 0.12);

/// Places from `low` to `high`, fine within [fine_low, fine_high].
std::vector<double> Knots(double low, double high, double fine_low, double fine_high) {
  std::vector<double> knots;
  const auto add = [&knots](double from, double to, double step) {
    if (to <= from) return;
    const int pieces = std::max(1, static_cast<int>(std::ceil((to - from) / step)));
    for (int i = 0; i < pieces; ++i) knots.push_back(from + (to - from) * i / pieces);
  };
  add(low, fine_low, kCoarse_mm);
  add(std::max(low, fine_low), std::min(high, fine_high), kFine_mm);
  add(fine_high, high, kCoarse_mm);
  return knots;
}

}  // namespace

double LimbRadius(const LimbOptions& o, double angle, double along) {
  const double calf = std::exp(-std::pow((along + 70) / 110, 2));
  const double taper = 1 - 0.25 * along / o.length_mm;
  return o.radius_mm * (taper + 0.10 * calf) * (1 + 0.04 * std::cos(2 * angle) + 0.015 * std::cos(3 * angle + 0.5));
}

double CraterDepth(const LimbOptions& o, double angle, double along) {
  const double rho = detail::CraterRho(o, angle, along);
  if (rho >= 1) return 0;
  const double wall = 1 - std::pow(rho, o.crater.wall);
  return o.crater.depth_mm * wall * wall;
}

Result<Limb> MakeLimb(const LimbOptions& o) {
  const CraterOptions& c = o.crater;
  const double reach = 1 + c.irregularity;
  const double half_angle = c.radius_mm * reach / o.radius_mm;
  const bool finite = std::isfinite(c.depth_mm + c.radius_mm + c.elongation + c.irregularity + c.wall + c.angle_deg +
                                    c.along_mm + o.radius_mm + o.length_mm + o.distance_mm);
  if (!finite || c.depth_mm < 0 || c.radius_mm <= 0 || c.elongation <= 0 || c.wall < 2 || c.irregularity < 0 ||
      c.irregularity > 0.3 || c.depth_mm > 0.6 * o.radius_mm || half_angle + std::abs(c.angle_deg) * kPi / 180 > 1.2 ||
      c.radius_mm * c.elongation * reach + std::abs(c.along_mm) > 0.4 * o.length_mm) {
    return Fail(ErrorCode::kUsage, "the crater does not fit onto the limb; make it smaller, shallower or more central");
  }
  const double centre = c.angle_deg * kPi / 180, half_along = c.radius_mm * c.elongation * reach + 1;
  // Angles as arc lengths on the nominal radius, so that both directions have the same spacing.
  const auto arcs = Knots(-kPi * o.radius_mm, kPi * o.radius_mm, centre * o.radius_mm - c.radius_mm * reach - 3,
                          centre * o.radius_mm + c.radius_mm * reach + 3);
  const auto alongs = Knots(-o.length_mm / 2, o.length_mm / 2, c.along_mm - half_along, c.along_mm + half_along);
  Limb limb;
  TriangleMesh& mesh = limb.mesh;
  for (const double along : alongs) {
    for (const double arc : arcs) {
      const double angle = arc / o.radius_mm;
      const Eigen::Vector3d point =
          detail::LimbPoint(angle, along, LimbRadius(o, angle, along) - CraterDepth(o, angle, along));
      const double bed = 1 - detail::SmootherStep(0.97, 1.03, detail::CraterRho(o, angle, along));
      const double granulation = 1 + 0.12 * bed * detail::ValueNoise(point / 3, o.seed + 9);
      mesh.vertex.push_back(point);
      mesh.albedo.push_back(detail::Skin((kSkin + bed * (kBed - kSkin)) * granulation, point, 0.10, o.seed));
    }
  }
  AppendGridTriangles(0, static_cast<int>(arcs.size()), static_cast<int>(alongs.size()), true, mesh);
  ComputeNormals(mesh);
  limb.truth = detail::IntegrateWound(o);
  const Eigen::Matrix3d rotation = RotationFromPose(0, o.pitch_deg, o.lean_deg);
  const Eigen::Vector3d place(0, 0, o.distance_mm + LimbRadius(o, 0, 0));
  Move(rotation, place, mesh);
  for (Eigen::Vector3d& point : limb.truth.outline_in_camera) point = rotation * point + place;
  return limb;
}

}  // namespace striae::rig
