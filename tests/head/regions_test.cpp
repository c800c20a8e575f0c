#include "analysis/head/regions.h"

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/head/angles.h"
#include "analysis/head/measure.h"
#include "tests/head/bust.h"

namespace striae::head {
namespace {

using testing::Bust;
using testing::CameraFromSubject;
using ::testing::HasSubstr;
using testing::SeenFromTheFront;

TEST(HeadRegions, ComeBackFromTheirJson) {
  Regions drawn;
  drawn.head_px = {{10, 20}, {30.5, 20}, {30, 40}};
  drawn.image_sha256 = Sha256{};
  const auto read = RegionsFromJson(ToJsonText(drawn));
  ASSERT_TRUE(read) << read.error().Describe();
  EXPECT_EQ(read->head_px, drawn.head_px);
  EXPECT_TRUE(read->torso_px.empty());
  EXPECT_EQ(read->image_sha256, drawn.image_sha256);
}

TEST(HeadRegions, SayWhatIsWrongWithThem) {
  const auto why = [](const char* text) {
    const auto read = RegionsFromJson(text);
    EXPECT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::kBadFile);
    return read.error().Describe();
  };
  EXPECT_THAT(why("no"), HasSubstr("JSON object"));
  EXPECT_THAT(why("{}"), HasSubstr("no region"));
  EXPECT_THAT(why(R"({"head_px": [[1,2],[3,4]]})"), HasSubstr("head_px"));
  EXPECT_THAT(why(R"({"torso_px": [[0,0],[9,9],[9,0],[0,9]]})"), HasSubstr("torso_px"));
  EXPECT_THAT(why(R"({"brow_px": [5,5]})"), HasSubstr("only together"));
  EXPECT_THAT(why(R"({"brow_px": [5], "chin_px": [5,9]})"), HasSubstr("brow_px must be"));
  EXPECT_THAT(why(R"({"head_px": [[0,0],[9,0],[0,9]], "image_sha256": 5})"), HasSubstr("image_sha256"));
}

/// The bust's sensor has 2 mm pixels at 2 m; the base of its neck is at (220, 140), its chin about row 118.
Regions Drawn() {
  Regions drawn;
  drawn.head_px = {{190, 35}, {250, 35}, {250, 95}, {190, 95}};
  drawn.torso_px = {{150, 165}, {290, 165}, {290, 290}, {150, 290}};
  return drawn;
}

TEST(HeadRegions, DrawnOnesAreMeasuredOnAndKept) {
  Bust bust;
  bust.head_rotation = Compose({Angle::Degrees(15), Angle::Degrees(5), Angle::Degrees(-5), {}});
  const Surface neutral = SeenFromTheFront({}, 0.5, 1), pose = SeenFromTheFront(bust, 0.5, 2);
  Options options;
  options.regions = Drawn();
  const auto report = Measure(neutral, pose, options);
  ASSERT_TRUE(report) << report.error().Describe();
  Eigen::Matrix3d measured;
  for (int i = 0; i < 9; ++i) measured(i / 3, i % 3) = report->details["rotation_matrix"][i / 3][i % 3].get<double>();
  const Eigen::Matrix3d truth = CameraFromSubject() * bust.head_rotation * CameraFromSubject().transpose();
  EXPECT_LT(Eigen::AngleAxisd(measured * truth.transpose()).angle() * 180 / M_PI, 0.3);  // as with found ones
  const auto& kept = report->details["regions"];
  EXPECT_EQ(kept["head_source"], "drawn");
  EXPECT_EQ(kept["head_px"][2][1], 95.0);
  const auto found = Measure(neutral, pose);
  ASSERT_TRUE(found) << found.error().Describe();
  EXPECT_EQ(found->details["regions"]["torso_source"], "found");
  // What was found can be handed back as drawn.
  EXPECT_TRUE(RegionsFromJson(found->details["regions"].dump()));
}

TEST(HeadRegions, OnNothingAreRefused) {
  const Surface neutral = SeenFromTheFront({}, 0.5, 1);
  Options options;
  options.regions = Drawn();
  for (auto& p : options.regions.head_px) p.x() -= 180;  // beside the head
  const auto report = Measure(neutral, neutral, options);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kMeasurementRefused);
  EXPECT_THAT(report.error().Describe(), HasSubstr("too little of the face"));
}

TEST(HeadRegions, NeedASurfaceWithPixels) {
  Surface neutral = SeenFromTheFront({}, 0.5, 1);
  neutral.col.clear();
  neutral.row.clear();
  Options options;
  options.regions = Drawn();
  EXPECT_EQ(Measure(neutral, neutral, options).error().code, ErrorCode::kUsage);
}

}  // namespace
}  // namespace striae::head
