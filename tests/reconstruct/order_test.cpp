#include "reconstruct/order.h"

#include <algorithm>
#include <cmath>

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

TEST(SplitDoubtfulRegions, LeavesALimbWhole) {
  const FringeScene scene{SmallQuarterRig(), UprightLimb(1000, 60)};
  PhaseResult phase = PhaseOf(scene);
  const auto before = phase.unwrapped.region.pixels();
  const auto sheets = SplitDoubtfulRegions(phase);
  EXPECT_EQ(static_cast<int>(sheets.size()), phase.unwrapped.regions);
  EXPECT_TRUE(std::equal(before.begin(), before.end(), phase.unwrapped.region.pixels().begin()));
}

/// Two parts of one sheet: the stripes of a wide plane, dimmed along a band as along an arm's outline.
PhaseResult Dimmed(double amplitude_left, int from_col) {
  PhaseResult phase = PhaseOf({SmallQuarterRig(), Plane(1000, 0, 0, 400, 300)});
  const int period = static_cast<int>(phase.carrier_period_px), middle = phase.mask.height() / 2;
  for (int row = middle - period / 3; row <= middle + period / 3; ++row) {
    for (int col = from_col; col < phase.mask.width(); ++col)
      phase.amplitude(col, row) *= static_cast<float>(amplitude_left);
  }
  return phase;
}

TEST(SplitDoubtfulRegions, PartsARegionAlongALineOfDimmedStripes) {
  PhaseResult phase = Dimmed(0.6, 0);
  ASSERT_EQ(phase.unwrapped.regions, 1);
  const ImageF order = phase.unwrapped.phase;
  const auto sheets = SplitDoubtfulRegions(phase);
  ASSERT_EQ(sheets, (std::vector<int>{0, 0}));
  ASSERT_EQ(phase.unwrapped.pixels.size(), 2U);
  EXPECT_GE(phase.unwrapped.pixels[0], phase.unwrapped.pixels[1]);
  const int col = phase.mask.width() / 2, quarter = phase.mask.height() / 4;
  EXPECT_NE(phase.unwrapped.region(col, quarter), phase.unwrapped.region(col, 3 * quarter));
  EXPECT_EQ(phase.unwrapped.phase(col, quarter), order(col, quarter));
  std::vector<std::size_t> counted(2, 0);
  for (const int region : phase.unwrapped.region.pixels()) {
    if (region >= 0) ++counted.at(static_cast<std::size_t>(region));
  }
  EXPECT_EQ(counted, phase.unwrapped.pixels);
}

TEST(SplitDoubtfulRegions, LeavesARegionWholeThatIsJoinedBesideTheDimmedLine) {
  PhaseResult phase = Dimmed(0.6, 0);
  PhaseResult open = Dimmed(0.6, phase.mask.width() / 3);
  EXPECT_EQ(SplitDoubtfulRegions(open).size(), 1U);
}

TEST(SplitDoubtfulRegions, DoesNotTakeAFaintLineForAJoint) {
  PhaseResult phase = Dimmed(0.95, 0);
  EXPECT_EQ(SplitDoubtfulRegions(phase).size(), 1U);
}

}  // namespace
}  // namespace striae::reconstruct
