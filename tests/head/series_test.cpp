#include "analysis/head/series.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace striae::head {
namespace {

AnalysisReport Angles(double rotation, double flexion, double tilt, double uncertainty = 0.5) {
  AnalysisReport report;
  for (const auto& [name, value] : {std::pair{"rotation", rotation}, {"flexion", flexion}, {"tilt", tilt}}) {
    Measurement m;
    m.name = name;
    m.value = value;
    m.unit = "deg";
    m.uncertainty = uncertainty;
    report.measurements.push_back(m);
  }
  return report;
}

TEST(HeadSeries, TheRangeOfMotionReachesFromTheFarthestPoseOnOneSideToThatOnTheOther) {
  const std::vector<AnalysisReport> poses = {Angles(-60, 2, 5, 0.3), Angles(55, -1, 7, 0.4), Angles(10, 40, 9)};
  const auto range = RangeOfMotion(poses);
  ASSERT_EQ(range.size(), 3U);
  EXPECT_EQ(range[0].name, "rotation");
  EXPECT_DOUBLE_EQ(range[0].least_deg, -60);
  EXPECT_EQ(range[0].least_pose, 0U);
  EXPECT_EQ(range[0].most_pose, 1U);
  EXPECT_DOUBLE_EQ(range[0].range_deg, 115);
  EXPECT_DOUBLE_EQ(range[0].uncertainty_deg, 0.5);  // of 0.3 and 0.4
}

TEST(HeadSeries, TheNeutralPoseIsPartOfTheRange) {
  const std::vector<AnalysisReport> poses = {Angles(20, 0, 12), Angles(30, 0, 15)};
  const auto range = RangeOfMotion(poses);
  EXPECT_DOUBLE_EQ(range[0].least_deg, 0);
  EXPECT_FALSE(range[0].least_pose);
  EXPECT_DOUBLE_EQ(range[0].range_deg, 30);
  EXPECT_DOUBLE_EQ(range[0].uncertainty_deg, 0.5);  // the neutral pose is zero by definition
  EXPECT_FALSE(range[1].most_pose);
}

TEST(HeadSeries, SemOfTwoCapturesEachIsTheRootOfHalfTheMeanSquaredDifference) {
  const std::vector<std::vector<AnalysisReport>> groups = {{Angles(10, 0, 1), Angles(13, 0, 1)},
                                                           {Angles(-30, 0, 1), Angles(-34, 0, 1)}};
  const auto found = PoseRepeatability(groups);
  ASSERT_EQ(found.size(), 3U);
  const double sem = std::sqrt((9.0 + 16.0) / 4);  // differences 3 and 4
  EXPECT_NEAR(found[0].sem_deg, sem, 1e-12);
  EXPECT_NEAR(found[0].mdc95_deg, 1.96 * std::sqrt(2.0) * sem, 1e-12);
  EXPECT_EQ(found[0].degrees_of_freedom, 2U);
  EXPECT_EQ(found[1].sem_deg, 0);
}

TEST(HeadSeries, SemIsTheNoiseWhateverThePoses) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.4);
  std::vector<std::vector<AnalysisReport>> groups;
  for (int pose = 0; pose < 40; ++pose) {
    std::vector<AnalysisReport> group;
    for (int i = 0; i < 11; ++i) group.push_back(Angles(3.0 * pose + noise(random), 0, 0));
    groups.push_back(group);
  }
  // 400 degrees of freedom: sd of the sd is 1 / sqrt(800) = 3.5 %; three of them.
  EXPECT_NEAR(PoseRepeatability(groups)[0].sem_deg, 0.4, 0.4 * 0.105);
}

TEST(HeadSeries, PosesTakenOnceSayNothingOfRepeatability) {
  const std::vector<std::vector<AnalysisReport>> groups = {{Angles(10, 0, 1)}, {Angles(13, 0, 1)}};
  EXPECT_TRUE(PoseRepeatability(groups).empty());
  EXPECT_TRUE(PoseRepeatability({}).empty());
}

TEST(HeadSeries, AReportOfSomethingElseIsAProgrammersError) {
  const std::vector<AnalysisReport> wound(1);
  EXPECT_THROW(RangeOfMotion(wound), std::logic_error);
}

}  // namespace
}  // namespace striae::head
