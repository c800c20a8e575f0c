#include "acquire/rig/detail/texture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace striae::rig::detail {
namespace {

double Lattice(std::int64_t x, std::int64_t y, std::int64_t z, unsigned seed) {
  std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15U ^
                    static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FU ^
                    static_cast<std::uint64_t>(z) * 0x165667B19E3779F9U ^ (seed + 1ULL) * 0xD6E8FEB86659FD93U;
  h ^= h >> 32U;
  h *= 0xD6E8FEB86659FD93U;
  h ^= h >> 32U;
  h *= 0xD6E8FEB86659FD93U;
  h ^= h >> 32U;
  return static_cast<double>(h >> 11U) * 0x1.0p-52 - 1;
}

}  // namespace

double SmootherStep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * t * (10 + t * (6 * t - 15));
}

double ValueNoise(const Eigen::Vector3d& p, unsigned seed) {
  const Eigen::Vector3d floor = p.array().floor();
  const auto x = static_cast<std::int64_t>(floor.x()), y = static_cast<std::int64_t>(floor.y()),
             z = static_cast<std::int64_t>(floor.z());
  const double u = SmootherStep(0, 1, p.x() - floor.x()), v = SmootherStep(0, 1, p.y() - floor.y()),
               w = SmootherStep(0, 1, p.z() - floor.z());
  const auto row = [&](std::int64_t dy, std::int64_t dz) {
    return std::lerp(Lattice(x, y + dy, z + dz, seed), Lattice(x + 1, y + dy, z + dz, seed), u);
  };
  return std::lerp(std::lerp(row(0, 0), row(1, 0), v), std::lerp(row(0, 1), row(1, 1), v), w);
}

Eigen::Vector3f Skin(const Eigen::Vector3d& base, const Eigen::Vector3d& point, double amount, unsigned seed) {
  const double brightness = 0.5 * ValueNoise(point / 25, seed) + 0.35 * ValueNoise(point / 8, seed + 1) +
                            0.25 * ValueNoise(point / 2.5, seed + 2);
  const double redness = ValueNoise(point / 15, seed + 3);
  Eigen::Vector3d albedo = base * (1 + amount * brightness);
  albedo.x() *= 1 + 0.3 * amount * redness;
  albedo.y() *= 1 - 0.3 * amount * redness;
  return albedo.cwiseMax(0.0).cwiseMin(1.0).cast<float>();
}

}  // namespace striae::rig::detail
