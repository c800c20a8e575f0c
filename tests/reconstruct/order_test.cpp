#include "reconstruct/order.h"

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

}  // namespace
}  // namespace striae::reconstruct
