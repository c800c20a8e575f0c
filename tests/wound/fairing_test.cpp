// CGAL's fairing across a wound against sheets whose bi-Laplacian is known.
#include "analysis/wound/detail/fairing.h"

#include <cmath>

#include <gtest/gtest.h>

namespace striae::wound {
namespace {

using Height = std::function<double(double, double)>;

// Points between 0.6 and 1.2 of the ring's radius, 0.02 apart; `whole` false leaves out a third of it.
std::vector<Eigen::Vector3d> RingOn(const Height& height, bool whole = true) {
  std::vector<Eigen::Vector3d> ring;
  for (double u = -1.2; u <= 1.2; u += 0.02) {
    for (double v = -1.2; v <= 1.2; v += 0.02) {
      const double r = std::hypot(u, v);
      if (r < 0.6 || r > 1.2 || (!whole && u > 0.4)) continue;
      ring.emplace_back(u, v, height(u, v));
    }
  }
  return ring;
}

std::optional<FairedSheet> Faired(const Height& smooth, bool whole = true) {
  const auto ring = RingOn(smooth, whole);
  return FairAcross(ring, std::vector<double>(ring.size(), 1), smooth);
}

TEST(Fairing, LeavesAPlaneAsItIs) {
  const auto sheet = Faired([](double u, double v) { return 0.2 * u - 0.1 * v; });
  ASSERT_TRUE(sheet);
  for (const double u : {-0.4, 0.0, 0.3}) EXPECT_NEAR(sheet->At(u, 0.1), 0, 1e-9);
}

TEST(Fairing, KeepsAShallowBowl) {
  // The bi-Laplacian of r^2 is zero in the plane; the sheet's own metric differs from it by the slope squared (0.06 at
  // the rim), hence by as much of the bowl's height of 0.075.
  const auto sheet = Faired([](double u, double v) { return -0.2 * (u * u + v * v); });
  ASSERT_TRUE(sheet);
  EXPECT_NEAR(sheet->At(0, 0), 0, 0.06 * 0.075);
}

TEST(Fairing, TakesAwayWhatTheRimDoesNotAskFor) {
  const double bump = 0.1;
  const auto sheet = Faired([&](double u, double v) { return bump * std::exp(-(u * u + v * v) / (2 * 0.12 * 0.12)); });
  ASSERT_TRUE(sheet);
  EXPECT_NEAR(sheet->At(0, 0), -bump, 0.02 * bump);  // at the rim the bump has left 4e-6 of itself
  EXPECT_NEAR(sheet->At(0.9, 0), 0, 1e-12);          // the ring itself stays
}

TEST(Fairing, NeedsAClosedRing) {
  EXPECT_FALSE(Faired([](double, double) { return 0.0; }, false));
}

}  // namespace
}  // namespace striae::wound
