// What must not be measured, and what is measured but flagged.
#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "analysis/wound/wound.h"
#include "tests/wound/bodies.h"

namespace striae::wound {
namespace {

using striae::testing::Body;
using striae::testing::Camera;
using striae::testing::CircleOn;
using striae::testing::Keep;
using striae::testing::Observe;
using ::testing::HasSubstr;

const Camera kCamera{.width = 360, .height = 360, .focal_px = 2000};
const Body kBody{.radius_mm = 60, .crater_radius_mm = 12};

const Surface& Limb() {
  static const Surface kLimb = Observe(kBody, kCamera);
  return kLimb;
}

Outline Wound() { return CircleOn(kBody, kCamera, 12); }

void ExpectRefusal(const Result<AnalysisReport>& result, ErrorCode code, const char* words) {
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, code) << result.error().Describe();
  EXPECT_THAT(result.error().message, HasSubstr(words));
}

Outline Shifted(double col, double row) {
  Outline outline = Wound();
  for (auto& p : outline.polygon_px) p += Eigen::Vector2d(col, row);
  return outline;
}

TEST(WoundRefused, WithoutSensorPixels) {
  Surface surface = Limb();
  surface.col.clear();
  surface.row.clear();
  ExpectRefusal(Measure(surface, Wound()), ErrorCode::kBadFile, "sensor pixels");
}

TEST(WoundRefused, OutlineLeavesTheSensor) {
  ExpectRefusal(Measure(Limb(), Shifted(170, 0)), ErrorCode::kOutlineOffSurface, "leaves the sensor");
}

TEST(WoundRefused, OutlineBesideTheLimb) {
  // The limb is 60 mm to either side at 2 px a mm; nothing lies beyond 130 px from the middle.
  ExpectRefusal(Measure(Limb(), Shifted(154, 0)), ErrorCode::kOutlineOffSurface, "outline");
}

TEST(WoundRefused, OutlineAcrossTheLimbsEdge) {
  ExpectRefusal(Measure(Limb(), Shifted(115, 0)), ErrorCode::kOutlineOffSurface, "connected skin");
}

TEST(WoundRefused, OutlineCrossesItself) {
  Outline outline = Wound();
  std::swap(outline.polygon_px[10], outline.polygon_px[50]);
  ExpectRefusal(Measure(Limb(), outline), ErrorCode::kBadFile, "crosses itself");
}

TEST(WoundRefused, OutlineOfTwoPoints) {
  Outline outline = Wound();
  outline.polygon_px.resize(2);
  ExpectRefusal(Measure(Limb(), outline), ErrorCode::kBadFile, "three points");
}

TEST(WoundRefused, OutlineNotFinite) {
  Outline outline = Wound();
  outline.polygon_px[3].x() = std::numeric_limits<double>::quiet_NaN();
  ExpectRefusal(Measure(Limb(), outline), ErrorCode::kBadFile, "not finite");
}

TEST(WoundRefused, SpeckOfAFewPixels) {
  ExpectRefusal(Measure(Limb(), CircleOn(kBody, kCamera, 1)), ErrorCode::kMeasurementRefused, "small");
}

TEST(WoundRefused, EmptySurface) {
  ExpectRefusal(Measure(Keep(Limb(), [](int, int) { return false; }), Wound()), ErrorCode::kOutlineOffSurface,
                "hardly any");
}

TEST(WoundRefused, LargeHoleInTheBed) {
  const Surface holed = Keep(Limb(), [](int col, int row) { return std::hypot(col - 179.5, row - 179.5) > 14; });
  ExpectRefusal(Measure(holed, Wound()), ErrorCode::kMeasurementRefused, "missing");
}

TEST(WoundRefused, RingCutOffByTheSurfacesEdge) {
  // 12 mm of wound and 3 mm of skin are 30 px; a ring needs 14 mm.
  const Surface cut = Keep(Limb(), [](int col, int row) { return std::hypot(col - 179.5, row - 179.5) < 30; });
  ExpectRefusal(Measure(cut, Wound()), ErrorCode::kMeasurementRefused, "healthy skin");
}

TEST(WoundRefused, SkinBendsAwayBeyondSixtyDegrees) {
  // A finger: half of the ring lies where a cylinder of 16 mm has turned by more than 60 degrees.
  const Body finger{.radius_mm = 16, .crater_radius_mm = 8, .crater_depth_mm = 2};
  const Camera near{.width = 360, .height = 360, .focal_px = 4000};
  ExpectRefusal(Measure(Observe(finger, near), CircleOn(finger, near, 8)), ErrorCode::kMeasurementRefused, "");
}

TEST(WoundRefused, OutlineOfAnotherPhotograph) {
  Surface surface = Limb();
  Outline outline = Wound();
  Sha256 drawn_on, made_from;
  drawn_on.bytes[0] = 1;
  made_from.bytes[0] = 2;
  surface.comments = {"photograph sha256 " + made_from.ToString()};
  outline.image_sha256 = drawn_on;
  ExpectRefusal(Measure(surface, outline), ErrorCode::kOutlineOffSurface, "another photograph");
  outline.image_sha256 = made_from;
  EXPECT_TRUE(Measure(surface, outline));
}

TEST(WoundRefused, OptionsThatCannotBeMeant) {
  Options options;
  options.gaps_mm = {4, 2};
  ExpectRefusal(Measure(Limb(), Wound(), options), ErrorCode::kUsage, "ascending");
  options = {};
  options.cell_mm = 0;
  ExpectRefusal(Measure(Limb(), Wound(), options), ErrorCode::kUsage, "positive");
}

TEST(WoundFlagged, SmallHoleIsBridgedAndSaid) {
  const Surface holed = Keep(Limb(), [](int col, int row) { return std::hypot(col - 179.5, row - 179.5) > 5; });
  const auto report = Measure(holed, Wound());
  ASSERT_TRUE(report) << report.error().Describe();
  EXPECT_THAT(report->Find("volume")->reason, HasSubstr("bridged"));
  EXPECT_EQ(report->Find("area")->status, Measurement::Status::kOk);  // the boundary is whole
  // The membrane across 2.5 mm in radius of a parabola loses at most D (2.5 / 12)^4: 0.2 %.
  EXPECT_NEAR(report->Find("volume")->value, kBody.CraterVolumeMm3() / 1000, 0.01 * kBody.CraterVolumeMm3() / 1000);
}

TEST(WoundFlagged, AnotherWoundInTheRingIsLeftOut) {
  // A pit 3 mm deep and 14 px (7 mm) wide in the ring: 5 % of its area, so left out without a word, but it must not
  // pull the skin down: unweighted it would by 3 mm x 5 %, which is 3 % of this wound's volume.
  Surface surface = Limb();
  for (std::size_t k = 0; k < surface.size(); ++k) {
    if (std::hypot(surface.col[k] - 179.5 - 42, surface.row[k] - 179.5) < 7) surface.point_in_camera[k] *= 1.003F;
  }
  const auto report = Measure(surface, Wound());
  ASSERT_TRUE(report) << report.error().Describe();
  EXPECT_NEAR(report->Find("volume")->value, kBody.CraterVolumeMm3() / 1000, 0.01 * kBody.CraterVolumeMm3() / 1000);
}

TEST(WoundFlagged, RingPartlyUnseen) {
  const Surface cut = Keep(Limb(), [](int col, int) { return col < 179.5 + 24 + 14; });
  const auto report = Measure(cut, Wound());
  ASSERT_TRUE(report) << report.error().Describe();
  EXPECT_THAT(report->Find("volume")->reason, HasSubstr("ring of skin was seen"));
}

}  // namespace
}  // namespace striae::wound
