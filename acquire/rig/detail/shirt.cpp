#include <cmath>

#include "acquire/rig/detail/dress.h"
#include "acquire/rig/detail/texture.h"

namespace striae::rig::detail {
namespace {

constexpr double kBand_mm = 14;  // of the striped shirt: 1.3 stripes of light at 2 m, a trap for any carrier search
const Eigen::Vector3d kPlain(0.42, 0.45, 0.50), kNavy(0.035, 0.045, 0.10), kWhite(0.72, 0.72, 0.70);
const Eigen::Vector3d kDark(0.018, 0.018, 0.020);  // black cotton reflects 2 to 3 %

/// Round neckline: lower in front.
bool BelowCollar(const Eigen::Vector3d& p) { return p.y() > 42 + 26 * std::exp(-p.x() * p.x() / 2500) - 0.12 * p.z(); }

}  // namespace

void PutOnShirt(Shirt shirt, unsigned seed, TriangleMesh& torso) {
  if (shirt == Shirt::kNone) return;
  for (std::size_t i = 0; i < torso.vertex.size(); ++i) {
    const Eigen::Vector3d& p = torso.vertex[i];
    if (!BelowCollar(p)) continue;
    Eigen::Vector3d cloth = shirt == Shirt::kDark ? kDark : kPlain;
    if (shirt == Shirt::kStriped) {
      // Printed bands with edges about 1 mm wide, a little wavy as cloth hangs.
      const double place = (p.y() + 2 * ValueNoise(p / 40, seed + 31)) / kBand_mm;
      const double in_band = std::abs(place - 2 * std::round(place / 2));  // 0 in the middle of white, 1 of navy
      cloth = kWhite + SmootherStep(0.46, 0.54, in_band) * (kNavy - kWhite);
    }
    // The weave's irregularity.
    torso.albedo[i] = (cloth * (1 + 0.06 * ValueNoise(p / 2, seed + 32))).cast<float>();
  }
}

}  // namespace striae::rig::detail
