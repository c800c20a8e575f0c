// Probing error and sphere spacing after VDI/VDE 2634 part 2 on balls of known form.
#include <gmock/gmock.h>

#include "reconstruct/verify/verify.h"
#include "tests/reconstruct/artefacts.h"

namespace striae::reconstruct {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using namespace striae::testing;

const Vector3d kAhead(20, -10, 1000);
// float32 coordinates (see verify_plane_test), seen at up to 60 degrees.
constexpr double kRounding = 4e-4;

TEST(BallCheck, FindsNothingWrongWithAPerfectBall) {
  const auto check = CheckBall(Seen({Ball(kAhead, 50)}), 100, {});
  ASSERT_TRUE(check) << check.error().Describe();
  EXPECT_LT(check->form_mm, kRounding);
  EXPECT_LT(check->sd_mm, kRounding);
  EXPECT_NEAR(check->size_error_mm, 0, kRounding);
  EXPECT_LT((check->centre - kAhead).norm(), kRounding);
  EXPECT_GT(check->filled, 0.99);
}

TEST(BallCheck, MeasuresAWrongSize) {
  for (const double wrong : {-2.0, 0.6, 3.0}) {
    const auto check = CheckBall(Seen({Ball(kAhead, 50 + wrong / 2)}), 100, {});
    ASSERT_TRUE(check) << check.error().Describe();
    EXPECT_NEAR(check->size_error_mm, wrong, kRounding);
    EXPECT_LT(check->form_mm, kRounding) << "a wrong size is no wrong form";
  }
}

TEST(BallCheck, MeasuresAWrongForm) {
  // Four lobes about the line of sight: no sphere fits them better than the round one in their middle.
  constexpr double kLobe = 0.1;
  const auto check = CheckBall(Seen({Ball(kAhead, 50, [](double phi) { return kLobe * std::cos(4 * phi); })}), 100, {});
  ASSERT_TRUE(check) << check.error().Describe();
  // Lobes are seen at a slightly other angle than the round ball: kLobe^2 / radius, and a cap of 60 degrees gives the
  // radius with a lever of some thirty.
  constexpr double kSecondOrder = 30 * kLobe * kLobe / 50;
  EXPECT_NEAR(check->form_mm, 2 * kLobe, 0.02 * kLobe + kSecondOrder) << "0.3 % of the points are the lobes' tips";
  EXPECT_NEAR(check->sd_mm, kLobe / std::sqrt(2.0), 0.02 * kLobe);
  EXPECT_NEAR(check->size_error_mm, 0, 2 * kSecondOrder);
}

TEST(BallCheck, IsFoundBesideOtherThings) {
  const Surface scene = WithNoise(
      Seen({Ball(kAhead, 30), Plate({0, 0, 1090}, 160, 0.1), Limb({-100, 0, 1050}, 45), Ball({130, 0, 1000}, 15)}),
      0.1);
  const auto check = CheckBall(scene, 60, {});
  ASSERT_TRUE(check) << check.error().Describe();
  // 3,000 points of 0.1 mm, diameter and centre along z correlated: 0.02 mm; three times that.
  EXPECT_LT((check->centre - kAhead).norm(), 0.06);
  EXPECT_NEAR(check->size_error_mm, 0, 0.06);
}

TEST(BallCheck, LeavesOutAsManyPointsAsTheGuidelineAllowsAndNoMore) {
  const auto with_outliers = [](std::size_t step) {
    Surface surface = Seen({Ball(kAhead, 50)});
    for (std::size_t i = step / 2; i < surface.size(); i += step) surface.point_in_camera[i] *= 0.998F;  // 2 mm
    return CheckBall(surface, 100, {});
  };
  EXPECT_LT(with_outliers(450)->form_mm, 0.05) << "0.22 %";
  EXPECT_GT(with_outliers(200)->form_mm, 0.9) << "0.5 %: the steepest are moved by half along the radius";
}

void ExpectNoBall(const Surface& surface, double diameter_mm, const char* words) {
  const auto check = CheckBall(surface, diameter_mm, {});
  ASSERT_FALSE(check) << check->diameter_mm << " mm, filled " << check->filled;
  EXPECT_EQ(check.error().code, ErrorCode::kMeasurementRefused);
  EXPECT_THAT(check.error().Describe(), HasSubstr(words));
}

TEST(BallCheck, RefusesTooLittleOfABall) {
  const Surface ball = Seen({Ball({0, 0, 1000}, 50)});
  ExpectNoBall(Only(ball, [](int col, int) { return col < 268; }), 100, "is visible");
  ExpectNoBall(Only(ball, [](int col, int row) { return std::hypot(col - 268, row - 178) < 30; }), 100, "is visible");
  const auto most = CheckBall(Only(ball, [](int col, int) { return col < 300; }), 100, {});
  ASSERT_TRUE(most) << "four fifths of it are enough: " << most.error().Describe();
}

TEST(BallCheck, RefusesWhatIsNoBallOfThatSize) {
  ExpectNoBall(Seen({Plate(kAhead, 100, 0.2)}), 100, "no ball of 100 mm");
  ExpectNoBall(Seen({Limb({0, 0, 1060}, 50)}), 100, "no ball of 100 mm");
  ExpectNoBall(Seen({Ball(kAhead, 60)}), 100, "no ball of 100 mm");
  ExpectNoBall(Seen({Ball(kAhead, 40)}), 100, "no ball of 100 mm");
  ExpectNoBall(Seen({Ball(kAhead, 8)}), 16, "too few points");
  Surface empty;
  empty.sensor_width_px = kSensorWidth;
  empty.sensor_height_px = kSensorHeight;
  ExpectNoBall(empty, 100, "too few points");
}

TEST(BallCheck, RefusesNonsense) {
  for (const double diameter : {0.0, -3.0, std::nan("")}) {
    const auto check = CheckBall(Seen({Ball(kAhead, 50)}), diameter, {});
    ASSERT_FALSE(check);
    EXPECT_EQ(check.error().code, ErrorCode::kUsage);
  }
}

TEST(DistanceCheck, MeasuresTheSpacingOfTwoBalls) {
  const Vector3d left(-70, 20, 980), right(75, -10, 1020);
  const double distance = (right - left).norm();
  const auto check = CheckDistance(Seen({Ball(right, 30), Ball(left, 30.2)}), 60, distance - 0.5, {});
  ASSERT_TRUE(check) << check.error().Describe();
  EXPECT_NEAR(check->distance_mm, distance, kRounding);
  EXPECT_NEAR(check->error_mm, 0.5, kRounding);
  EXPECT_LT((check->first.centre - left).norm(), kRounding) << "left first";
  EXPECT_NEAR(check->first.size_error_mm, 0.4, kRounding);
  EXPECT_NEAR(check->second.size_error_mm, 0, kRounding);
}

TEST(DistanceCheck, NeedsBothBalls) {
  const auto one = CheckDistance(Seen({Ball({0, 0, 1000}, 30), Plate({0, 0, 1100}, 150, 0)}), 60, 150, {});
  ASSERT_FALSE(one);
  EXPECT_THAT(one.error().Describe(), HasSubstr("the second ball"));
  const auto inside = CheckDistance(Seen({Ball({0, 0, 1000}, 30)}), 60, 50, {});
  ASSERT_FALSE(inside);
  EXPECT_EQ(inside.error().code, ErrorCode::kUsage);
}

}  // namespace
}  // namespace striae::reconstruct
