#include "core/outline.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>

namespace striae {
namespace {

using ::testing::HasSubstr;

TEST(Outline, SurvivesWritingAndReading) {
  Outline outline{{{10, 10}, {20.5, 11}, {15, 30.25}}, Sha256{}};
  const auto back = OutlineFromJson(ToJsonText(outline));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->polygon_px, outline.polygon_px);
  EXPECT_EQ(back->image_sha256, outline.image_sha256);
}

TEST(Outline, LabelMesPixelCornersBecomePixelCentres) {
  const auto outline = OutlineFromJson(
      R"({"shapes":[{"label":"wound","shape_type":"polygon","points":[[10.5,10.5],[20.5,10.5],[15.5,20.5]]}]})");
  ASSERT_TRUE(outline) << outline.error().message;
  EXPECT_EQ(outline->polygon_px.front(), Eigen::Vector2d(10, 10));
}

TEST(Outline, SaysWhyItIsNone) {
  const struct {
    const char* text;
    const char* why;
  } cases[] = {{R"({"polygon_px":[[1,1],[2,2]]})", "three points"},
               {R"({"polygon_px":[[0,0],[10,10],[10,0],[0,10]]})", "crosses itself"},
               {R"({"polygon_px":[[0,0],[10,1e9],[10,0]]})", "no pixel"},
               {R"({"shapes":[]})", "no polygon"},
               {R"({"shapes":[{"points":[[0,0],[1,0],[0,1]]},{"points":[[0,0],[1,0],[0,1]]}]})", "several polygons"},
               {R"({"polygon_px":[[0],[1],[2]]})", "not an outline"},
               {"not json", "not an outline"}};
  for (const auto& [text, why] : cases) {
    const auto outline = OutlineFromJson(text);
    ASSERT_FALSE(outline) << text;
    EXPECT_EQ(outline.error().code, ErrorCode::kBadFile);
    EXPECT_THAT(outline.error().message, HasSubstr(why));
  }
}

TEST(Outline, LosesTheSmallLoopsOfAShakingHand) {
  // Points a twentieth of the radius apart, each moved by as much: such lines cross themselves in dozens of places.
  std::mt19937 engine(1);
  const auto off = [&] { return 10.0 * (static_cast<double>(engine()) / 4294967295.0 - 0.5); };
  Outline drawn;
  for (int k = 0; k < 125; ++k) {
    drawn.polygon_px.emplace_back(500 + 100 * std::cos(k * 2 * M_PI / 125) + off(),
                                  500 + 100 * std::sin(k * 2 * M_PI / 125) + off());
  }
  ASSERT_TRUE(SelfCrossing(drawn.polygon_px));
  const auto outline = OutlineFromJson(ToJsonText(drawn));
  ASSERT_TRUE(outline) << outline.error().message;
  EXPECT_FALSE(SelfCrossing(outline->polygon_px));
  double area = 0;
  for (std::size_t k = 0; k < outline->polygon_px.size(); ++k) {
    const auto& a = outline->polygon_px[k];
    const auto& b = outline->polygon_px[(k + 1) % outline->polygon_px.size()];
    area += (a.x() * b.y() - a.y() * b.x()) / 2;
  }
  // The mean of 125 offsets of sd 2.9 px moves the line by 0.26 px: 0.5 % of the area; three times that.
  EXPECT_NEAR(area, M_PI * 1e4, 0.015 * M_PI * 1e4);
}

TEST(Outline, InsideFollowsTheEvenOddRule) {
  const std::vector<Eigen::Vector2d> u = {{0, 0}, {30, 0}, {30, 30}, {20, 30}, {20, 10}, {10, 10}, {10, 30}, {0, 30}};
  EXPECT_TRUE(Inside(u, {5, 20}));
  EXPECT_TRUE(Inside(u, {25, 20}));
  EXPECT_FALSE(Inside(u, {15, 20}));
  EXPECT_FALSE(Inside(u, {-1, 5}));
}

}  // namespace
}  // namespace striae
