// The closed body between two sheets, against textbook solids.
#include <cmath>

#include <gmock/gmock.h>

#include "analysis/wound/detail/closed_volume.h"

namespace striae::wound {
namespace {

using ::testing::HasSubstr;

// A square grid over a disc of radius a + one step; the bed is `bed(rho)`, the skin is flat.
template <typename BedAt>
SheetPair OverDisc(double a, double step, BedAt bed) {
  const int n = static_cast<int>(std::ceil(a / step)) + 1, width = 2 * n + 1;
  SheetPair pair;
  for (int j = -n; j <= n; ++j) {
    for (int i = -n; i <= n; ++i) {
      const double x = i * step, y = j * step;
      pair.skin.emplace_back(x, y, 0);
      pair.bed.emplace_back(x, y, bed(std::hypot(x, y)));
    }
  }
  for (int j = 0; j + 1 < width; ++j) {
    for (int i = 0; i + 1 < width; ++i) {
      const auto at = [&](int c, int r) { return static_cast<std::uint32_t>((j + r) * width + i + c); };
      pair.triangles.push_back({at(0, 0), at(1, 0), at(0, 1)});
      pair.triangles.push_back({at(1, 0), at(1, 1), at(0, 1)});
    }
  }
  return pair;
}

double PrismSumOf(const SheetPair& pair) {
  double volume = 0;
  for (const auto& t : pair.triangles) {
    const Eigen::Vector3d ab = pair.bed[t[1]] - pair.bed[t[0]], ac = pair.bed[t[2]] - pair.bed[t[0]];
    double height = 0;
    for (const auto v : t) height += (pair.skin[v] - pair.bed[v]).z() / 3;
    volume += (ab.x() * ac.y() - ab.y() * ac.x()) / 2 * height;
  }
  return volume;
}

TEST(VolumeBetweenSheets, OfASphericalCapInAFlatPlate) {
  const double sphere = 25, a = 15, depth = sphere - std::sqrt(sphere * sphere - a * a);
  const auto cap = [&](double rho) {
    return rho < a ? -(std::sqrt(sphere * sphere - rho * rho) - (sphere - depth)) : 0.0;
  };
  const auto volume = VolumeBetween(OverDisc(a, 0.25, cap));
  ASSERT_TRUE(volume) << volume.error().Describe();
  const double truth = M_PI * depth * depth * (3 * sphere - depth) / 3;
  // Chords below the arc lose about step^2 / (8 sphere) of depth: 0.01 % here; the rim's steps add as much.
  EXPECT_NEAR(*volume, truth, 0.001 * truth);
}

TEST(VolumeBetweenSheets, EqualsTheSumOfVerticalPrisms) {
  const auto pair = OverDisc(10, 0.5, [](double rho) { return -3 * std::cos(rho); });
  const auto volume = VolumeBetween(pair);
  ASSERT_TRUE(volume);
  EXPECT_NEAR(*volume, PrismSumOf(pair), 1e-9 * 1200);  // two exact formulas of one body: rounding of 1200 mm3 only
}

TEST(VolumeBetweenSheets, TissueAboveTheSkinCountsNegative) {
  const auto volume = VolumeBetween(OverDisc(10, 0.5, [](double rho) { return rho < 8 ? 1.0 : 0.0; }));
  ASSERT_TRUE(volume);
  EXPECT_LT(*volume, -M_PI * 49);  // at least the part that is surely 1 mm high
}

TEST(VolumeBetweenSheets, RefusesATriangulationThatIsNotManifold) {
  SheetPair pair = OverDisc(2, 1, [](double) { return -1.0; });
  pair.triangles.push_back(pair.triangles.front());
  const auto volume = VolumeBetween(pair);
  ASSERT_FALSE(volume);
  EXPECT_THAT(volume.error().message, HasSubstr("manifold"));
}

}  // namespace
}  // namespace striae::wound
