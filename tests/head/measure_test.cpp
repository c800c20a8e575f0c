#include "analysis/head/measure.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/head/angles.h"
#include "tests/head/bust.h"

namespace striae::head {
namespace {

using ::testing::AnyOf;
using testing::Bust;
using testing::CameraFromSubject;
using ::testing::HasSubstr;
using testing::SeenFromTheFront;

constexpr double kNoiseMm = 0.5;  // of the large grating at 2 m

Eigen::Matrix3d Turned(double rotation_deg, double flexion_deg, double tilt_deg) {
  return Compose({Angle::Degrees(rotation_deg), Angle::Degrees(flexion_deg), Angle::Degrees(tilt_deg), {}});
}

/// The whole person moves between the captures: a step of 20 mm and 8 deg about a slanting axis.
Eigen::Isometry3d Moved() {
  return Eigen::Translation3d(10, -8, 15) *
         Eigen::AngleAxisd(8 * M_PI / 180, Eigen::Vector3d(0.3, 0.8, -0.4).normalized());
}

const Surface& Neutral() {
  static const Surface surface = SeenFromTheFront({}, kNoiseMm, 1);
  return surface;
}

Eigen::Matrix3d MatrixOf(const AnalysisReport& report) {
  Eigen::Matrix3d m;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      m(static_cast<int>(i), static_cast<int>(k)) = report.details["rotation_matrix"][i][k].get<double>();
    }
  }
  return m;
}

/// Angle between the measured and the true rotation of the head against the torso, deg.
double ErrorDeg(const AnalysisReport& report, const Eigen::Matrix3d& true_in_subject) {
  const Eigen::Matrix3d truth = CameraFromSubject() * true_in_subject * CameraFromSubject().transpose();
  return Eigen::AngleAxisd(MatrixOf(report).transpose() * truth).angle() * 180 / M_PI;
}

struct Pose {
  double rotation, flexion, tilt;
};

class HeadPoses : public ::testing::TestWithParam<Pose> {};

TEST_P(HeadPoses, AreMeasuredWhileThePersonMovesAsAWhole) {
  const Pose pose = GetParam();
  Bust bust;
  bust.head_rotation = Turned(pose.rotation, pose.flexion, pose.tilt);
  bust.torso_motion = Moved();
  bust.jaw_drop_mm = 5;  // the mouth opens: the jaw is not part of the patch
  bust.shrug_mm = 10;
  const auto report = Measure(Neutral(), SeenFromTheFront(bust, kNoiseMm, 2));
  ASSERT_TRUE(report) << report.error().Describe();
  // Trials with other bodies at this noise: mean 0.14, p95 0.27 deg.
  EXPECT_LT(ErrorDeg(*report, bust.head_rotation), 0.3);
  // The sequence spreads that over the angles, by 1 / cos(tilt) at most.
  EXPECT_NEAR(report->Find("rotation")->value, pose.rotation, 0.4);
  EXPECT_NEAR(report->Find("flexion")->value, pose.flexion, 0.4);
  EXPECT_NEAR(report->Find("tilt")->value, pose.tilt, 0.4);
  for (const Measurement& m : report->measurements) {
    EXPECT_EQ(m.unit, "deg");
    EXPECT_EQ(m.code.scheme, "99STRIAE");
    EXPECT_EQ(m.status, Measurement::Status::kOk);
    EXPECT_GE(m.uncertainty, 0.05);  // never better than what is wrong all over a patch
    EXPECT_LT(m.uncertainty, 4);
  }
}

INSTANTIATE_TEST_SUITE_P(All, HeadPoses,
                         ::testing::Values(Pose{0, 0, 0}, Pose{20, 0, 0}, Pose{0, 20, 0}, Pose{0, 0, 20},
                                           Pose{-15, 10, -12}, Pose{40, 0, 0}, Pose{-55, 5, 5}, Pose{10, -25, 35}),
                         [](const auto& pose) {
                           const auto word = [](double d) {
                             return (d < 0 ? "minus" : "") + std::to_string(std::lround(std::abs(d)));
                           };
                           return word(pose.param.rotation) + "_" + word(pose.param.flexion) + "_" +
                                  word(pose.param.tilt);
                         });

TEST(HeadMeasure, ADeepBreathCostsLessThanADegree) {
  Bust bust;
  bust.head_rotation = Turned(20, 0, 0);
  bust.breath_mm = 4;  // the chest's own skin turns: 4 mm over its 260 mm are 0.9 deg
  const auto report = Measure(Neutral(), SeenFromTheFront(bust, kNoiseMm, 2));
  ASSERT_TRUE(report) << report.error().Describe();
  EXPECT_LT(ErrorDeg(*report, bust.head_rotation), 1.0);
}

TEST(HeadMeasure, ReportsWhatTheContractNames) {
  Bust bust;
  bust.head_rotation = Turned(20, 0, 0);
  const auto report = Measure(Neutral(), SeenFromTheFront(bust, kNoiseMm, 2));
  ASSERT_TRUE(report) << report.error().Describe();
  const nlohmann::json json = ToJson(*report);
  EXPECT_EQ(json["analysis"], "head");
  EXPECT_EQ(json["axes_source"], "camera");
  for (const char* part : {"head", "torso"}) {
    EXPECT_GT(json["overlap"][part].get<double>(), 0.8);
    EXPECT_LT(json["residual_mm"][part].get<double>(), 1.0);  // two captures of 0.5 mm each: 0.7
  }
  EXPECT_NEAR(MatrixOf(*report).determinant(), 1, 1e-12);
  EXPECT_THAT(json["words"]["rotation"].get<std::string>(), HasSubstr("to the subject's left"));
}

TEST(HeadMeasure, TheOppositeQuestionHasTheTransposedAnswer) {
  Bust bust;
  bust.head_rotation = Turned(-15, 10, 5);
  const Surface pose = SeenFromTheFront(bust, kNoiseMm, 2);
  const auto there = Measure(Neutral(), pose);
  const auto back = Measure(pose, Neutral());
  ASSERT_TRUE(there);
  ASSERT_TRUE(back) << back.error().Describe();
  // The torso stood still, so both rotations are in the same axes; each may be off by 0.3 deg.
  EXPECT_LT(Eigen::AngleAxisd(MatrixOf(*there) * MatrixOf(*back)).angle() * 180 / M_PI, 0.6);
}

TEST(HeadMeasure, SameInputGivesTheSameBytes) {
  Bust bust;
  bust.head_rotation = Turned(10, 0, 0);
  const Surface pose = SeenFromTheFront(bust, kNoiseMm, 2);
  EXPECT_EQ(ToJson(Measure(Neutral(), pose).value()).dump(), ToJson(Measure(Neutral(), pose).value()).dump());
}

TEST(HeadMeasure, ASurfaceWithoutSensorGridIsThinnedInSpace) {
  Bust bust;
  bust.head_rotation = Turned(20, 0, 0);
  Surface neutral = Neutral(), pose = SeenFromTheFront(bust, kNoiseMm, 2);
  for (Surface* s : {&neutral, &pose}) {
    s->col.clear();
    s->row.clear();
  }
  const auto report = Measure(neutral, pose);
  ASSERT_TRUE(report) << report.error().Describe();
  EXPECT_LT(ErrorDeg(*report, bust.head_rotation), 0.3);
}

void ExpectRefused(const Result<AnalysisReport>& result, const std::string& why) {
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kMeasurementRefused);
  EXPECT_THAT(result.error().Describe(), HasSubstr(why));
}

TEST(HeadMeasureRefuses, ASphere) {
  const Surface sphere = testing::SphereSeenFromTheFront(180, kNoiseMm, 1);
  ExpectRefused(Measure(sphere, sphere), "no head over shoulders");
}

TEST(HeadMeasureRefuses, TheBackOfTheHead) {
  Bust away;
  away.torso_motion = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY());
  const Surface back = SeenFromTheFront(away, kNoiseMm, 1);
  const auto result = Measure(back, SeenFromTheFront(away, kNoiseMm, 2));
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().Describe(), AnyOf(HasSubstr("no nose"), HasSubstr("too smooth")));
  ExpectRefused(Measure(Neutral(), back), "of the neutral capture");
}

TEST(HeadMeasureRefuses, ATorsoWithoutHead) {
  Bust bust;
  bust.with_head = false;
  const auto result = Measure(SeenFromTheFront(bust, kNoiseMm, 1), Neutral());
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kMeasurementRefused);
  EXPECT_THAT(result.error().Describe(), AnyOf(HasSubstr("no head over shoulders"), HasSubstr("no nose")));
}

TEST(HeadMeasureRefuses, AHeadThatIsABall) {
  Bust bust;
  bust.ball_for_head = true;
  // 1 mm: noise makes a sphere look rough, and must not pass for a face.
  const Surface neutral = SeenFromTheFront(bust, 1.0, 1);
  bust.head_rotation = Turned(20, 0, 0);
  const auto result = Measure(neutral, SeenFromTheFront(bust, 1.0, 2));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kMeasurementRefused);
  EXPECT_THAT(result.error().Describe(), AnyOf(HasSubstr("no nose"), HasSubstr("too smooth")));
}

TEST(HeadMeasureRefuses, AHeadWithoutTorso) {
  Surface head = Neutral(), cut = Neutral();
  cut.point_in_camera.clear();
  cut.col.clear();
  cut.row.clear();
  for (std::size_t i = 0; i < head.size(); ++i) {
    if (head.row[i] > 145) continue;  // the base of the neck is at row 140
    cut.point_in_camera.push_back(head.point_in_camera[i]);
    cut.col.push_back(head.col[i]);
    cut.row.push_back(head.row[i]);
  }
  const auto result = Measure(cut, Neutral());
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kMeasurementRefused);
}

TEST(HeadMeasureRefuses, AnotherBody) {
  Bust other;
  other.ball_for_head = true;
  ExpectRefused(Measure(Neutral(), SeenFromTheFront(other, kNoiseMm, 2)), "the head of the neutral capture");
  const Surface sphere = testing::SphereSeenFromTheFront(180, kNoiseMm, 1);
  ExpectRefused(Measure(Neutral(), sphere), "the torso of the neutral capture");
}

TEST(HeadMeasureRefuses, AHeadOneStripeOutOfOrder) {
  // One stripe of the large grating is 135 mm of depth at 2 m; the head slides along its rays.
  Surface slipped = Neutral();
  for (std::size_t i = 0; i < slipped.size(); ++i) {
    if (slipped.row[i] < 125) slipped.point_in_camera[i] *= 2135.F / 2000.F;
  }
  const auto result = Measure(Neutral(), slipped);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kMeasurementRefused);
}

TEST(HeadMeasureRefuses, EmptySurfaces) {
  ExpectRefused(Measure({}, Neutral()), "too few points");
  ExpectRefused(Measure(Neutral(), {}), "too few points");
}

TEST(HeadMeasure, OptionsThatCannotBeMeantAreWrongUsage) {
  Options along_the_axis;
  along_the_axis.up_in_camera = {0, 0, 1};
  EXPECT_EQ(Measure(Neutral(), Neutral(), along_the_axis).error().code, ErrorCode::kUsage);
  Options no_samples;
  no_samples.resamples = 0;
  EXPECT_EQ(Measure(Neutral(), Neutral(), no_samples).error().code, ErrorCode::kUsage);
}

}  // namespace
}  // namespace striae::head
