#include "reconstruct/order.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>

#include "tests/reconstruct/fringes.h"

namespace striae::reconstruct {
namespace {

using striae::testing::FringeScene;
using striae::testing::Plane;
using striae::testing::Render;
using striae::testing::SmallQuarterRig;
using striae::testing::UprightLimb;

PhaseResult PhaseOf(const FringeScene& scene) {
  auto phase = MeasurePhase(Render(scene));
  if (!phase) throw std::runtime_error(phase.error().message);
  return *std::move(phase);
}

TEST(GratingEdge, IsSeenAtBothEndsOfALimbLongerThanTheField) {
  const FringeScene scene{SmallQuarterRig(), UprightLimb(1000, 60)};
  const auto edges = FindGratingEdges(PhaseOf(scene), 1);
  ASSERT_TRUE(edges.front().low);
  ASSERT_TRUE(edges.front().high);
  // OPTICS: half of the plateau is at -0.5 .. -0.59 and N - 0.5 +- 0.06, so the ends are N = 35 stripes apart.
  EXPECT_NEAR(edges.front().high->order - edges.front().low->order, 35, 0.15);
  EXPECT_LT(edges.front().low->scatter, 0.13);
}

TEST(GratingEdge, IsNotTakenFromTheEndOfAPlate) {
  // Straight, square to the stripes, and inside of the field: only the missing surface beyond tells it apart.
  const FringeScene scene{SmallQuarterRig(), Plane(1000, 0, 0, 80, 70)};
  const auto edges = FindGratingEdges(PhaseOf(scene), 1);
  EXPECT_FALSE(edges.front().low);
  EXPECT_FALSE(edges.front().high);
}

TEST(ResolveOrder, TheEdgeDecidesWhateverTheExpectedDistanceSays) {
  const FringeScene scene{SmallQuarterRig(), UprightLimb(1000, 60)};
  const PhaseResult phase = PhaseOf(scene);
  const auto right = ResolveOrder(phase, scene.rig, 1000), misled = ResolveOrder(phase, scene.rig, 1090);
  EXPECT_EQ(right.front().source, OrderSource::kGratingEdge);
  EXPECT_EQ(right.front().offset, misled.front().offset);
  EXPECT_GT(right.front().margin, 0.5);
}

TEST(ResolveOrder, WithoutStripeCountTheDistanceDecidesAndSaysHowSure) {
  FringeScene scene{SmallQuarterRig(), UprightLimb(1000, 60)};
  const PhaseResult phase = PhaseOf(scene);
  scene.rig.stripes.reset();
  const auto orders = ResolveOrder(phase, scene.rig, 1020);
  EXPECT_EQ(orders.front().source, OrderSource::kDistance);
  EXPECT_LT(orders.front().margin, 1);
}

TEST(OrderMargin, IsNothingHalfwayBetweenTwoWholeNumbersAndGrowsStraightFromThere) {
  FringeScene scene{SmallQuarterRig(), UprightLimb(1000, 60)};
  const PhaseResult phase = PhaseOf(scene);
  scene.rig.stripes.reset();  // the distance alone decides
  // The distance is told in steps of half a millimetre; one stripe is tens of them.
  std::vector<double> margins;
  std::vector<std::size_t> changes;
  int last = 0;
  for (double told = 960; told < 1060; told += 0.5) {
    const RegionOrder order = ResolveOrder(phase, scene.rig, told).front();
    if (!margins.empty() && order.offset != last) changes.push_back(margins.size());
    last = order.offset;
    margins.push_back(order.margin);
    EXPECT_NE(order.warning, "") << told;  // other whole numbers fit the working range
  }
  ASSERT_GE(changes.size(), 2U);
  const std::size_t from = changes[0], to = changes[1];
  const double most =
      *std::max_element(margins.begin() + static_cast<long>(from), margins.begin() + static_cast<long>(to));
  const double step = 2 * most / static_cast<double>(to - from);  // from nothing to the most within half a stripe
  for (const std::size_t change : {from, to}) EXPECT_LT(std::min(margins[change - 1], margins[change]), 1.1 * step);
  // Straight up and down again; 5 % for the depth per stripe, which changes with the distance.
  for (std::size_t i = from; i < to; ++i) {
    const double from_change = static_cast<double>(std::min(i - from, to - i)) + (i - from < to - i ? 0.5 : -0.5);
    EXPECT_NEAR(margins[i], step * from_change, 0.05 * most + step) << i;
  }
  EXPECT_LT(most, 0.5);  // at least two whole numbers fit: never more than one over their count
}

TEST(SettleOrder, LeavesALimbWhole) {
  const FringeScene scene{SmallQuarterRig(), UprightLimb(1000, 60)};
  PhaseResult phase = PhaseOf(scene);
  const auto before = phase.unwrapped.region.pixels();
  const auto orders = SettleOrder(phase, Render(scene).colour, scene.rig, 1000);
  EXPECT_TRUE(std::equal(before.begin(), before.end(), phase.unwrapped.region.pixels().begin()));
  EXPECT_EQ(static_cast<int>(orders.size()), phase.unwrapped.regions);
  EXPECT_EQ(orders.front().source, OrderSource::kGratingEdge);
  EXPECT_EQ(orders.front().warning, "");
}

/// A wide plane whose stripes are dimmed along a band from column `from_col` on, as along an arm's outline: in the
/// amplitude, and (`dark`) in the picture too, as in the shadow below the arm.
struct Dimmed {
  FringeScene scene{SmallQuarterRig(), Plane(1000, 0, 0, 400, 300)};
  PhaseResult phase = PhaseOf(scene);
  ImageRgb picture = Render(scene).colour;

  Dimmed(double amplitude_left, int from_col, bool dark) {
    const int period = static_cast<int>(phase.carrier_period_px), middle = phase.mask.height() / 2;
    const int half = dark ? (4 * period) / 5 : period / 3;
    for (int row = middle - half; row <= middle + half; ++row) {
      for (int col = from_col; col < phase.mask.width(); ++col) {
        phase.amplitude(col, row) *= static_cast<float>(amplitude_left);
        if (dark) picture(col, row) = {30, 30, 30};
      }
    }
  }
  /// Regions with a warning, without one, and points of both.
  void Settle() { orders = SettleOrder(phase, picture, scene.rig, 1000); }
  [[nodiscard]] std::size_t Points() const {
    std::size_t points = 0;
    for (const RegionOrder& order : orders) points += order.points;
    return points;
  }
  std::vector<RegionOrder> orders;
};

TEST(SettleOrder, PartsARegionAlongAShadowThatThePhaseDoesNotKnowOf) {
  Dimmed dimmed(0.3, 0, true);
  ASSERT_EQ(dimmed.phase.unwrapped.regions, 1);
  const ImageF order = dimmed.phase.unwrapped.phase;
  const std::size_t points = dimmed.phase.unwrapped.pixels[0];
  dimmed.Settle();
  ASSERT_GE(dimmed.orders.size(), 2U);
  EXPECT_EQ(dimmed.Points(), points);  // nothing is taken out
  const int col = dimmed.phase.mask.width() / 2, quarter = dimmed.phase.mask.height() / 4;
  EXPECT_NE(dimmed.phase.unwrapped.region(col, quarter), dimmed.phase.unwrapped.region(col, 3 * quarter));
  EXPECT_EQ(dimmed.phase.unwrapped.phase(col, quarter), order(col, quarter));
  std::vector<std::size_t> counted(dimmed.orders.size(), 0);
  for (const int region : dimmed.phase.unwrapped.region.pixels()) {
    if (region >= 0) ++counted.at(static_cast<std::size_t>(region));
  }
  EXPECT_EQ(counted, dimmed.phase.unwrapped.pixels);
  // What casts the shadow is doubted, even where each part has an end of the grating for itself.
  const int above = dimmed.phase.unwrapped.region(col, quarter);
  EXPECT_NE(dimmed.orders.at(static_cast<std::size_t>(above)).warning, "");
}

TEST(SettleOrder, LeavesARegionWholeThatIsJoinedBesideTheDimmedLine) {
  Dimmed dimmed(0.6, SmallQuarterRig().image_width_px / 3, false);
  dimmed.Settle();
  EXPECT_EQ(dimmed.orders.size(), 1U);
}

TEST(SettleOrder, DoesNotTakeAFaintLineForAJoint) {
  Dimmed dimmed(0.95, 0, false);
  dimmed.Settle();
  EXPECT_EQ(dimmed.orders.size(), 1U);
}

}  // namespace
}  // namespace striae::reconstruct
