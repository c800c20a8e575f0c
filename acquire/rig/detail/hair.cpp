#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "acquire/rig/detail/dress.h"
#include "acquire/rig/detail/random.h"
#include "acquire/rig/detail/texture.h"

namespace striae::rig::detail {
namespace {

const Eigen::Vector3d kHeadCentre(0, -128, -12), kHeadHalf(75, 112, 95);
const Eigen::Vector3d kBrown(0.045, 0.028, 0.018);
constexpr int kShortLocks = 5200, kLongLocks = 6500;
constexpr int kPieces = 14;  // of a lock along its length

/// How far inside of the hairline a direction from the head's middle lies (y down, z backwards); negative: face.
double InsideHairline(const Eigen::Vector3d& d) {
  const double crown = -d.y() - (0.62 + 0.10 * d.x() * d.x());                   // above the forehead
  const double back = std::min(d.z() - 0.12, 0.62 - d.y());                      // behind the ears, above the nape
  const double temple = std::min({-d.y() - 0.12, std::abs(d.x()) - 0.80, 1.0});  // before the ears
  return std::max({crown, back, temple});
}

/// Where a strand that starts at direction d has come to after `run` mm.
Eigen::Vector3d OnScalp(const Eigen::Vector3d& d, double lift_mm) {
  Eigen::Vector3d p = d.cwiseProduct(kHeadHalf);
  p.x() *= 1 - 0.22 * SmootherStep(0, 100, p.y());
  return kHeadCentre + p + lift_mm * d.cwiseQuotient(kHeadHalf).normalized();
}

using Path = std::vector<Eigen::Vector3d>;

/// Combed down and away from the crown, lying on the head.
Path ShortLock(const Eigen::Vector3d& root, Random& random) {
  const double length = random.Uniform(28, 55), stand = random.Uniform(3, 11), drift = random.Uniform(-0.35, 0.35);
  const Eigen::Vector3d away = Eigen::Vector3d(root.x(), 0, root.z() + 0.02);
  const Eigen::Vector3d comb =
      Eigen::Vector3d(away.x(), 0.9, away.z()) + drift * Eigen::Vector3d(-away.z(), 0, away.x());
  Path path;
  Eigen::Vector3d d = root;
  for (int i = 0; i <= kPieces; ++i) {
    path.push_back(OnScalp(d, stand * SmootherStep(0, 1, static_cast<double>(i) / kPieces)));
    const Eigen::Vector3d step = comb - comb.dot(d) * d;
    d = (d + length / kPieces / kHeadHalf.x() * step.normalized()).normalized();
  }
  return path;
}

/// Follows the head down to its widest place, then falls; the locks of the front over the shoulders.
Path LongLock(const Eigen::Vector3d& root, Random& random) {
  Path path = ShortLock(root, random);
  const double side = root.x() < 0 ? -1 : 1, outwards = random.Uniform(66, 104), end_y = random.Uniform(120, 185);
  const bool front = std::abs(root.x()) > 0.35 && root.z() < 0.65;
  const double depth = random.Uniform(-8, 6), wave = random.Uniform(0, 2 * std::numbers::pi);
  const Eigen::Vector3d from = path.back();
  for (int i = 1; i <= 2 * kPieces; ++i) {
    const double t = static_cast<double>(i) / (2 * kPieces);
    Eigen::Vector3d p(0, std::lerp(from.y(), end_y, t), 0);
    const double settled = SmootherStep(0, 0.45, t), shoulder = SmootherStep(-40, 170, p.y());
    const double x = side * (outwards - 12 * shoulder) + 4 * std::sin(p.y() / 23 + wave);
    const double z = front ? depth - 8 - 125 * shoulder : depth + 60 + 75 * shoulder;
    p.x() = std::lerp(from.x(), x, settled);
    p.z() = std::lerp(from.z(), z, settled);
    path.push_back(p);
  }
  return path;
}

/// A three-sided tapering tube along the path.
void AppendLock(const Path& path, double radius, const Eigen::Vector3f& colour, TriangleMesh& mesh) {
  TriangleMesh lock;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Eigen::Vector3d along = (path[std::min(i + 1, path.size() - 1)] - path[i == 0 ? 0 : i - 1]).normalized();
    const Eigen::Vector3d e = along.unitOrthogonal(), f = e.cross(along);
    const double t = static_cast<double>(i) / static_cast<double>(path.size() - 1);
    const double r = radius * (1 - 0.85 * t * t);
    for (const double around : {0.0, 2.0943951, 4.1887902}) {
      lock.vertex.push_back(path[i] + r * (std::cos(around) * e + std::sin(around) * f));
      lock.albedo.push_back(colour * static_cast<float>(0.8 + 0.4 * t));
    }
  }
  AppendGridTriangles(0, 3, static_cast<int>(path.size()), true, lock);
  ComputeNormals(lock);
  Append(lock, mesh);
}

}  // namespace

TriangleMesh GrowHair(Hair hair, unsigned seed, TriangleMesh& head) {
  TriangleMesh locks;
  if (hair == Hair::kNone) return locks;
  for (std::size_t i = 0; i < head.vertex.size(); ++i) {
    const Eigen::Vector3d d = (head.vertex[i] - kHeadCentre).cwiseQuotient(kHeadHalf).normalized();
    const auto covered = static_cast<float>(SmootherStep(-0.03, 0.03, InsideHairline(d)));
    head.albedo[i] += covered * (kBrown.cast<float>() - head.albedo[i]);
  }
  Random random(seed * 0x9E3779B97F4A7C15U + 77);
  const int count = hair == Hair::kLong ? kLongLocks : kShortLocks;
  for (int grown = 0; grown < count;) {
    const Eigen::Vector3d any(random.Normal(), random.Normal(), random.Normal());
    if (any.norm() < 1e-3 || InsideHairline(any.normalized()) < 0) continue;
    const Eigen::Vector3d root = any.normalized();
    const Path path = hair == Hair::kLong ? LongLock(root, random) : ShortLock(root, random);
    const Eigen::Vector3f colour = (kBrown * random.Uniform(0.6, 1.6)).cast<float>();
    AppendLock(path, random.Uniform(0.5, 1.3), colour, locks);
    ++grown;
  }
  return locks;
}

}  // namespace striae::rig::detail
