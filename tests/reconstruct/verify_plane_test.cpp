// Flatness after VDI/VDE 2634 part 2 on plates of known form.
#include <gmock/gmock.h>

#include "reconstruct/verify/verify.h"
#include "tests/reconstruct/artefacts.h"

namespace striae::reconstruct {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using namespace striae::testing;

const Vector3d kAhead(0, 0, 1000);
// Coordinates are kept as float32: half a unit in the last place is 0.00003 mm at 1 m, 0.0002 mm in a range of many.
constexpr double kRounding = 2e-4;

double Saddle(double u, double v, double amplitude) { return amplitude * (u * u - v * v); }

TEST(PlaneCheck, FindsNothingWrongWithAFlatPlate) {
  for (const double tilt : {0.0, 0.3, -0.6}) {
    const auto check = CheckPlane(Seen({Plate(kAhead, 100, tilt)}), {});
    ASSERT_TRUE(check) << check.error().Describe();
    EXPECT_LT(check->flatness_mm, kRounding);
    EXPECT_LT(check->sd_mm, kRounding);
    const Vector3d normal(-std::sin(tilt), 0, -std::cos(tilt));
    EXPECT_GT(check->normal.dot(normal), 1 - 1e-9) << "towards the camera";
    EXPECT_NEAR(check->normal.dot(check->point - kAhead), 0, kRounding);
    EXPECT_NEAR(check->length_mm, 283, 4) << "the diagonal, to a pixel at each end";
  }
}

TEST(PlaneCheck, MeasuresTheFormOfASaddle) {
  constexpr double kAmplitude = 0.8;
  const Surface surface = Seen({Plate(kAhead, 100, 0.2, [](double u, double v) { return Saddle(u, v, kAmplitude); })});
  VerifyOptions all;
  all.rejected_share = 0;
  const auto check = CheckPlane(surface, all);
  ASSERT_TRUE(check) << check.error().Describe();
  // Its least-squares plane is the middle plane. A pixel is 0.008 of the half side, so that the highest point is missed
  // by at most 1 %; perspective weighs the tilted plate's halves unlike, which turns the plane a little.
  EXPECT_NEAR(check->flatness_mm, 2 * kAmplitude, 0.03 * kAmplitude);
  EXPECT_EQ(check->rejected, 0U);
  // Var(u^2 - v^2) = 2 (1/5 - 1/9) on the square.
  EXPECT_NEAR(check->sd_mm, kAmplitude * std::sqrt(8.0 / 45), 0.02 * kAmplitude);

  const auto permitted = CheckPlane(surface, {});
  ASSERT_TRUE(permitted);
  EXPECT_EQ(permitted->rejected, static_cast<std::size_t>(0.003 * static_cast<double>(surface.size())));
  EXPECT_LT(permitted->flatness_mm, check->flatness_mm);
  EXPECT_GT(permitted->flatness_mm, 0.85 * check->flatness_mm) << "0.3 % of a smooth form is little of it";
}

TEST(PlaneCheck, GivesTheScatterAsStandardDeviation) {
  const auto check = CheckPlane(WithNoise(Seen({Plate(kAhead, 100, 0.2)}), 0.1), {});
  ASSERT_TRUE(check);
  // Noise runs along the rays: its part along the normal is cos(0.2). 57,000 points: 0.3 % of the sd; 1 % allowed.
  EXPECT_NEAR(check->sd_mm, 0.1 * std::cos(0.2), 0.001);
  // Of a normal distribution without its 0.3 % largest, the range is twice 2.97 sd.
  EXPECT_NEAR(check->flatness_mm, 2 * 2.97 * 0.1 * std::cos(0.2), 0.02);
}

/// Every `step`-th point 5 mm nearer.
Surface WithOutliers(Surface surface, std::size_t step) {
  for (std::size_t i = step / 2; i < surface.size(); i += step) surface.point_in_camera[i] *= 0.995F;
  return surface;
}

TEST(PlaneCheck, LeavesOutAsManyPointsAsTheGuidelineAllowsAndNoMore) {
  const Surface plate = Seen({Plate(kAhead, 100, 0)});
  const auto few = CheckPlane(WithOutliers(plate, 400), {});  // 0.25 %
  ASSERT_TRUE(few);
  EXPECT_LT(few->flatness_mm, kRounding);
  EXPECT_NEAR(few->sd_mm, 5 * std::sqrt(0.0025), 0.01) << "the standard deviation is of all points";
  const auto more = CheckPlane(WithOutliers(plate, 250), {});  // 0.4 %
  ASSERT_TRUE(more);
  EXPECT_GT(more->flatness_mm, 4.9);
}

TEST(PlaneCheck, CountsAnIslandThatIsAStripeOff) {
  // A patch of 4 % within the plate at a wrong stripe order, 16 mm off: found as no part of the plane, but counted.
  Surface plate = Seen({Plate(kAhead, 100, 0)});
  for (std::size_t i = 0; i < plate.size(); ++i) {
    if (std::abs(plate.col[i] - 268) < 24 && std::abs(plate.row[i] - 178) < 24) plate.point_in_camera[i] *= 1.016F;
  }
  const auto check = CheckPlane(plate, {});
  ASSERT_TRUE(check);
  EXPECT_GT(check->flatness_mm, 15);
}

TEST(PlaneCheck, TakesThePlateAndNotWhatStandsAroundIt) {
  const Surface scene = Seen({Plate(kAhead, 80, 0.1), Ball({120, 0, 1000}, 25), Plate({-160, 0, 1080}, 40, 0.5)});
  const auto check = CheckPlane(scene, {});
  ASSERT_TRUE(check) << check.error().Describe();
  EXPECT_LT(check->flatness_mm, kRounding);
  EXPECT_NEAR(check->point.x(), 0, 1);
}

TEST(PlaneCheck, HardlyDependsOnTheSeed) {
  const Surface scene = WithNoise(Seen({Plate(kAhead, 100, 0.2)}), 0.2);
  VerifyOptions other;
  other.seed = 99;
  EXPECT_NEAR(CheckPlane(scene, {})->flatness_mm, CheckPlane(scene, other)->flatness_mm, 1e-9);
}

TEST(PlaneCheck, EvaluatesAnOutlineWholly) {
  const Surface scene = Seen({Plate(kAhead, 80, 0), Ball({0, 0, 1000}, 20)});
  VerifyOptions outlined;
  outlined.outline = Outline{{{180, 100}, {230, 100}, {230, 250}, {180, 250}}, {}};
  const auto beside = CheckPlane(scene, outlined);
  ASSERT_TRUE(beside);
  EXPECT_LT(beside->flatness_mm, kRounding);
  outlined.outline = Outline{{{180, 100}, {350, 100}, {350, 250}, {180, 250}}, {}};
  EXPECT_GT(CheckPlane(scene, outlined)->flatness_mm, 5) << "the ball is inside";
  outlined.outline = Outline{{{1, 1}, {20, 1}, {20, 20}, {1, 20}}, {}};
  const auto off = CheckPlane(scene, outlined);
  ASSERT_FALSE(off);
  EXPECT_EQ(off.error().code, ErrorCode::kOutlineOffSurface);
}

void ExpectNoPlane(const Surface& surface, const char* words) {
  const auto check = CheckPlane(surface, {});
  ASSERT_FALSE(check) << "flatness " << check->flatness_mm;
  EXPECT_EQ(check.error().code, ErrorCode::kMeasurementRefused);
  EXPECT_THAT(check.error().Describe(), HasSubstr(words));
  EXPECT_THAT(check.error().Describe(), HasSubstr("photograph a flat"));
}

TEST(PlaneCheck, RefusesWhatIsNoPlate) {
  ExpectNoPlane(Seen({Limb({0, 0, 1060}, 60)}), "bends away");
  ExpectNoPlane(Seen({Ball({0, 0, 1080}, 80)}), "bends away");
  ExpectNoPlane(Seen({Plate(kAhead, 8, 0)}), "too few");
  ExpectNoPlane(Surface{}, "too few");
}

}  // namespace
}  // namespace striae::reconstruct
