#include "reconstruct/verify/detail/sphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace striae::reconstruct::detail {
namespace {

using Eigen::Vector3d;

constexpr double kSearchCapRad = 70 * std::numbers::pi / 180;

/// Normals of a surface on its sensor grid, from points some pixels away: noise of single pixels hardly turns them.
class Normals {
 public:
  Normals(const Surface& surface, const Points& points, double radius_mm)
      : surface_(surface), index_(VertexIndexGrid(surface)) {
    std::vector<double> steps;
    for (const std::uint32_t i : Thin(points, 2000)) {
      const auto next = Index(surface.col[i] + 1, surface.row[i]);
      if (next) steps.push_back(std::abs(At(surface, *next).x() - At(surface, i).x()));
    }
    if (steps.empty()) return;
    std::nth_element(steps.begin(), steps.begin() + std::ssize(steps) / 2, steps.end());
    const double mm_per_pixel = std::max(steps[steps.size() / 2], 1e-3);
    reach_ = std::clamp(static_cast<int>(radius_mm / 6 / mm_per_pixel), 1, 200);
  }

  /// Unit, towards the camera; nothing at borders and holes.
  [[nodiscard]] std::optional<Vector3d> Of(std::uint32_t i) const {
    const int col = surface_.col[i], row = surface_.row[i];
    const auto left = Index(col - reach_, row), right = Index(col + reach_, row);
    const auto up = Index(col, row - reach_), down = Index(col, row + reach_);
    if (!left || !right || !up || !down) return std::nullopt;
    Vector3d normal =
        (At(surface_, *right) - At(surface_, *left)).cross(At(surface_, *down) - At(surface_, *up)).normalized();
    if (normal.dot(At(surface_, i)) > 0) normal = -normal;
    return normal;
  }

 private:
  [[nodiscard]] std::optional<std::uint32_t> Index(int col, int row) const {
    if (!index_.Contains(col, row) || index_(col, row) < 0) return std::nullopt;
    return static_cast<std::uint32_t>(index_(col, row));
  }

  const Surface& surface_;
  Image<std::int32_t> index_;
  int reach_ = 1;
};

/// Points near the sphere on its side towards the camera.
Points Near(const Surface& surface, const Points& points, const Sphere& sphere, double limit_mm) {
  Points near;
  for (const std::uint32_t i : points) {
    const Vector3d p = At(surface, i);
    if (std::abs(sphere.Distance(p)) < limit_mm && sphere.FacesRay(p, kSearchCapRad)) near.push_back(i);
  }
  return near;
}

}  // namespace

bool Sphere::FacesRay(const Vector3d& p, double cap_rad) const {
  const Vector3d ray = p.normalized();
  const double middle = ray.dot(centre);
  const double half = radius * radius - (centre.squaredNorm() - middle * middle);
  if (half <= 0 || middle <= 0) return false;
  const Vector3d outward = (middle - std::sqrt(half)) * ray - centre;
  return outward.dot(-centre) >= std::cos(cap_rad) * radius * centre.norm();
}

Sphere FitSphere(const Surface& surface, const Points& points, Sphere start) {
  constexpr int kMostRounds = 30;
  for (int round = 0; round < kMostRounds; ++round) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const std::uint32_t i : points) {
      const Vector3d d = At(surface, i) - start.centre;
      const double length = d.norm();
      if (length == 0) continue;
      Eigen::Vector4d slope;
      slope << -d / length, -1;
      normal += slope * slope.transpose();
      right -= slope * (length - start.radius);
    }
    const Eigen::Vector4d step = normal.ldlt().solve(right);
    if (!step.allFinite()) return start;
    start.centre += step.head<3>();
    start.radius += step[3];
    if (step.norm() < 1e-9 * std::abs(start.radius)) break;
  }
  return start;
}

std::optional<Sphere> FindSphere(const Surface& surface, const Points& points, double radius_mm, std::uint64_t seed) {
  constexpr int kTries = 1500;
  constexpr std::size_t kCounted = 4000;
  const Normals normals(surface, points, radius_mm);
  const Points counted = Thin(points, kCounted);
  Draw draw(seed);
  std::optional<Sphere> best;
  std::size_t most = 0;
  for (int i = 0; i < kTries; ++i) {
    const std::uint32_t drawn = points[draw.Below(points.size())];
    const auto normal = normals.Of(drawn);
    if (!normal) continue;
    const Sphere sphere{At(surface, drawn) - radius_mm * *normal, radius_mm};
    const std::size_t near = Near(surface, counted, sphere, 0.05 * radius_mm).size();
    if (near > most) {
      most = near;
      best = sphere;
    }
  }
  if (!best) return std::nullopt;
  for (int round = 0; round < 4; ++round) {
    const Points near = Near(surface, points, *best, 0.15 * radius_mm);
    if (near.size() < kFewestPoints) return std::nullopt;
    best = FitSphere(surface, near, *best);
    if (!(best->radius > 0.5 * radius_mm && best->radius < 2 * radius_mm)) return std::nullopt;
  }
  return best;
}

}  // namespace striae::reconstruct::detail
