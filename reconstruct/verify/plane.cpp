// Flatness: the least-squares plane and what is left of it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "reconstruct/verify/detail/region.h"
#include "reconstruct/verify/verify.h"

namespace striae::reconstruct {
namespace {

using detail::At;
using detail::Points;
using Eigen::Vector3d;

struct Plane {
  Vector3d point = Vector3d::Zero(), normal = Vector3d::Zero(), along = Vector3d::Zero();
  [[nodiscard]] double Distance(const Vector3d& p) const { return normal.dot(p - point); }
};

/// Total least squares: the plane through the centre along the two directions of largest spread.
Plane Fit(const Surface& surface, const Points& points) {
  Plane plane;
  for (const std::uint32_t i : points) plane.point += At(surface, i);
  plane.point /= static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : points) {
    const Vector3d d = At(surface, i) - plane.point;
    spread += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  plane.normal = axes.eigenvectors().col(0);
  plane.along = axes.eigenvectors().col(2);
  if (plane.normal.dot(plane.point) > 0) plane.normal = -plane.normal;
  return plane;
}

/// The plane through three of the points that most others lie near (RANSAC, Fischler and Bolles 1981).
std::optional<Plane> Search(const Surface& surface, const Points& points, double near_mm, std::uint64_t seed) {
  constexpr int kTries = 400;
  constexpr std::size_t kCounted = 4000;
  const Points counted = detail::Thin(points, kCounted);
  detail::Draw draw(seed);
  std::optional<Plane> best;
  std::size_t most = 0;
  for (int i = 0; i < kTries; ++i) {
    Plane plane;
    plane.point = At(surface, points[draw.Below(points.size())]);
    const Vector3d a = At(surface, points[draw.Below(points.size())]) - plane.point;
    const Vector3d b = At(surface, points[draw.Below(points.size())]) - plane.point;
    const Vector3d normal = a.cross(b);
    if (!(normal.norm() > 1e-6 * a.norm() * b.norm()) || normal.norm() == 0) continue;
    plane.normal = normal.normalized();
    const auto near = static_cast<std::size_t>(std::count_if(counted.begin(), counted.end(), [&](std::uint32_t p) {
      return std::abs(plane.Distance(At(surface, p))) < near_mm;
    }));
    if (near > most) {
      most = near;
      best = plane;
    }
  }
  return best;
}

Points Within(const Surface& surface, const Plane& plane, double limit_mm) {
  Points within;
  for (std::uint32_t i = 0; i < surface.size(); ++i) {
    if (std::abs(plane.Distance(At(surface, i))) < limit_mm) within.push_back(i);
  }
  return within;
}

double MedianDepth(const Surface& surface, const Points& points) {
  std::vector<double> depths;
  for (const std::uint32_t i : detail::Thin(points, 4000)) depths.push_back(At(surface, i).z());
  const auto middle = depths.begin() + std::ssize(depths) / 2;
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

/// The largest extent within the plane, to 1 % (twelve directions).
double Extent(const Surface& surface, const Points& points, const Plane& plane) {
  constexpr int kDirections = 12;
  const Vector3d across = plane.normal.cross(plane.along);
  double largest = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = i * std::numbers::pi / kDirections;
    const Vector3d direction = std::cos(angle) * plane.along + std::sin(angle) * across;
    std::vector<double> places;
    places.reserve(points.size());
    for (const std::uint32_t p : points) places.push_back(direction.dot(At(surface, p)));
    largest = std::max(largest, detail::RangeOf(places));
  }
  return largest;
}

tl::unexpected<Error> NoPlane(const std::string& why) {
  return Fail(ErrorCode::kMeasurementRefused,
              why + "; photograph a flat, matt, evenly white plate that fills most of the lit field");
}

/// The points of the largest flat part, or why there is none.
Result<Points> FindPlate(const Surface& surface, std::uint64_t seed) {
  Points all(surface.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  if (all.size() < detail::kFewestPoints) {
    return NoPlane("the surface has " + std::to_string(all.size()) + " points, too few for a plane");
  }
  const double depth = MedianDepth(surface, all);
  // Wide enough for a plate that a badly calibrated rig bends: 10 mm at 1 m.
  const double limit = 0.01 * depth;
  auto plane = Search(surface, all, 0.3 * limit, seed);
  if (!plane) return NoPlane("no plane passes through the points");
  Points part;
  for (int round = 0; round < 2; ++round) {
    part = detail::LargestConnected(surface, Within(surface, *plane, limit));
    if (part.size() < detail::kFewestPoints) return NoPlane("no flat part is large enough");
    plane = Fit(surface, part);
  }
  // A plate ends within the limit; a limb or a ball goes on through it.
  constexpr double kMostFarOnes = 0.05;
  const auto far = std::count_if(
      part.begin(), part.end(), [&](std::uint32_t i) { return std::abs(plane->Distance(At(surface, i))) > limit / 2; });
  if (static_cast<double>(far) > kMostFarOnes * static_cast<double>(part.size())) {
    return NoPlane("the flattest part bends away gradually: this is no plate, or the rig is far out of tolerance");
  }
  return detail::InHullOf(surface, part);
}

}  // namespace

Result<PlaneCheck> CheckPlane(const Surface& surface, const VerifyOptions& options) {
  const auto region = options.outline ? detail::InOutline(surface, *options.outline) : FindPlate(surface, options.seed);
  if (!region) return Fail(region.error());
  const auto distances = [&](const Plane& plane) {
    std::vector<double> d;
    d.reserve(region->size());
    for (const std::uint32_t i : *region) d.push_back(plane.Distance(At(surface, i)));
    return d;
  };
  Points kept;
  for (const std::size_t i : detail::Kept(distances(Fit(surface, *region)), options.rejected_share)) {
    kept.push_back((*region)[i]);
  }
  const Plane plane = Fit(surface, kept);
  std::vector<double> ranged;
  for (const std::uint32_t i : kept) ranged.push_back(plane.Distance(At(surface, i)));
  PlaneCheck check;
  check.point = plane.point;
  check.normal = plane.normal;
  check.flatness_mm = detail::RangeOf(ranged);
  check.sd_mm = detail::SdOf(distances(plane));
  check.length_mm = Extent(surface, detail::Thin(kept, 20000), plane);
  check.points = region->size();
  check.rejected = region->size() - kept.size();
  return check;
}

Tolerances DefaultTolerances(RigRange range) {
  return range == RigRange::kSmall ? Tolerances{1.0, 1.0, 0.5, 1.0} : Tolerances{5.0, 5.0, 2.5, 5.0};
}

RigRange RangeAt(double distance_mm) {
  constexpr double kBetweenTheRanges = 1500;
  return distance_mm < kBetweenTheRanges ? RigRange::kSmall : RigRange::kLarge;
}

}  // namespace striae::reconstruct
