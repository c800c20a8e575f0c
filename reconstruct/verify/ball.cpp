// Probing error on a ball, and the distance of two balls.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "reconstruct/verify/detail/sphere.h"
#include "reconstruct/verify/verify.h"

namespace striae::reconstruct {
namespace {

using detail::At;
using detail::Points;
using detail::Sphere;
using Eigen::Vector3d;

constexpr double kCapRad = kBallCapDeg * std::numbers::pi / 180;
constexpr double kOnBall = 0.05;        // of the radius: a point so near belongs to the ball
constexpr double kFewestOnBall = 0.85;  // share of the points before the cap that must
constexpr double kFewestFilled = 0.7;   // share of the cap that must be seen
constexpr double kMostWrongSize = 0.1;  // of the diameter: farther off, it is another ball

tl::unexpected<Error> NoBall(double diameter_mm, const std::string& why) {
  return Fail(ErrorCode::kMeasurementRefused,
              fmt::format("no ball of {:g} mm: {}; photograph a matt white ball of that diameter, whole and in focus, "
                          "and give its calibrated diameter",
                          diameter_mm, why));
}

/// Share of the cells of the cap, as seen from the camera, that have a point near the sphere.
double FilledShare(const Surface& surface, const Points& points, const Sphere& sphere) {
  constexpr int kCells = 12;
  const Vector3d axis = -sphere.centre.normalized();
  const Vector3d right = Vector3d::UnitY().cross(axis).normalized(), down = axis.cross(right);
  const double reach = std::sin(kCapRad);
  Mask cells(kCells, kCells);
  for (const std::uint32_t i : points) {
    const Vector3d u = (At(surface, i) - sphere.centre) / sphere.radius;
    if (std::abs(u.norm() - 1) > kOnBall) continue;
    const int col = static_cast<int>(std::floor((u.dot(right) / reach + 1) / 2 * kCells));
    const int row = static_cast<int>(std::floor((u.dot(down) / reach + 1) / 2 * kCells));
    if (cells.Contains(col, row)) cells(col, row) = 1;
  }
  int inside = 0, filled = 0;
  for (int row = 0; row < kCells; ++row) {
    for (int col = 0; col < kCells; ++col) {
      const double x = (col + 0.5) * 2 / kCells - 1, y = (row + 0.5) * 2 / kCells - 1;
      if (x * x + y * y > 1) continue;
      ++inside;
      filled += cells(col, row);
    }
  }
  return static_cast<double>(filled) / inside;
}

std::vector<double> Distances(const Surface& surface, const Points& points, const Sphere& sphere) {
  std::vector<double> d;
  d.reserve(points.size());
  for (const std::uint32_t i : points) d.push_back(sphere.Distance(At(surface, i)));
  return d;
}

BallCheck Evaluate(const Surface& surface, const Points& region, const Sphere& start, double diameter_mm,
                   double rejected_share) {
  Points kept;
  for (const std::size_t i : detail::Kept(Distances(surface, region, start), rejected_share)) {
    kept.push_back(region[i]);
  }
  const Sphere sphere = detail::FitSphere(surface, kept, start);
  BallCheck check;
  check.centre = sphere.centre;
  check.diameter_mm = 2 * sphere.radius;
  check.form_mm = detail::RangeOf(Distances(surface, kept, sphere));
  check.size_error_mm = check.diameter_mm - diameter_mm;
  check.sd_mm = detail::SdOf(Distances(surface, region, sphere));
  check.cap_deg = kBallCapDeg;
  check.filled = FilledShare(surface, kept, sphere);
  check.points = region.size();
  check.rejected = region.size() - kept.size();
  return check;
}

/// The ball among `points`; `whole` when all of them belong to it (an outline).
Result<BallCheck> CheckAmong(const Surface& surface, const Points& points, bool whole, double diameter_mm,
                             const VerifyOptions& options) {
  if (points.size() < detail::kFewestPoints) return NoBall(diameter_mm, "the surface has too few points");
  const auto found = detail::FindSphere(surface, points, diameter_mm / 2, options.seed);
  if (!found) return NoBall(diameter_mm, "nothing in the surface is round with that radius");
  Points region;
  for (const std::uint32_t i : points) {
    if (whole || found->FacesRay(At(surface, i), kCapRad)) region.push_back(i);
  }
  if (region.size() < detail::kFewestPoints) return NoBall(diameter_mm, "what is round is too small");
  const double on_ball =
      static_cast<double>(std::count_if(
          region.begin(), region.end(),
          [&](std::uint32_t i) { return std::abs(found->Distance(At(surface, i))) < kOnBall * found->radius; })) /
      static_cast<double>(region.size());
  if (on_ball < kFewestOnBall) {
    return NoBall(diameter_mm, fmt::format("only {:.0f} % of the points where it would be lie on it", 100 * on_ball));
  }
  BallCheck check = Evaluate(surface, region, *found, diameter_mm, options.rejected_share);
  if (std::abs(check.size_error_mm) > kMostWrongSize * diameter_mm) {
    return NoBall(diameter_mm, fmt::format("the ball in the surface measures {:.1f} mm", check.diameter_mm));
  }
  if (check.filled < kFewestFilled) {
    return NoBall(diameter_mm,
                  fmt::format("only {:.0f} % of its side towards the camera is visible", 100 * check.filled));
  }
  return check;
}

Status NeedsGrid(const Surface& surface) {
  if (surface.HasGrid()) return {};
  return Fail(ErrorCode::kBadFile,
              "the surface does not say which pixel each point came from; take the PLY that "
              "'striae reconstruct' wrote");
}

Result<Points> Candidates(const Surface& surface, const VerifyOptions& options) {
  if (options.outline) return detail::InOutline(surface, *options.outline);
  Points all(surface.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  return all;
}

}  // namespace

Result<BallCheck> CheckBall(const Surface& surface, double diameter_mm, const VerifyOptions& options) {
  if (!(diameter_mm > 0)) return Fail(ErrorCode::kUsage, "a ball's diameter must be positive");
  if (Status grid = NeedsGrid(surface); !grid) return Fail(grid.error());
  const auto points = Candidates(surface, options);
  if (!points) return Fail(points.error());
  return CheckAmong(surface, *points, options.outline.has_value(), diameter_mm, options);
}

Result<DistanceCheck> CheckDistance(const Surface& surface, double diameter_mm, double distance_mm,
                                    const VerifyOptions& options) {
  if (!(diameter_mm > 0) || !(distance_mm > diameter_mm)) {
    return Fail(ErrorCode::kUsage, "the balls' diameter must be positive and their distance larger than it");
  }
  if (Status grid = NeedsGrid(surface); !grid) return Fail(grid.error());
  const auto points = Candidates(surface, options);
  if (!points) return Fail(points.error());
  auto one = CheckAmong(surface, *points, false, diameter_mm, options);
  if (!one) return Fail(one.error(), "the first ball");
  Points rest;
  for (const std::uint32_t i : *points) {
    if ((At(surface, i) - one->centre).norm() > 0.65 * diameter_mm) rest.push_back(i);
  }
  auto other = CheckAmong(surface, rest, false, diameter_mm, options);
  if (!other) return Fail(other.error(), "the second ball");
  const Vector3d between = other->centre - one->centre;
  const bool beside = std::abs(between.x()) >= std::abs(between.y());
  if ((beside ? between.x() : between.y()) < 0) std::swap(*one, *other);
  return DistanceCheck{*one, *other, between.norm(), between.norm() - distance_mm};
}

}  // namespace striae::reconstruct
