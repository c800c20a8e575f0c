// Previews of a synthetic surface whose depth is known at every pixel.
#include "app/io/preview.h"

#include <gtest/gtest.h>

#include "report/picture.h"

namespace striae::app {
namespace {

/// A plane over sensor columns 100..499 and rows 50..249 whose depth grows with the column: 900 mm to 1000 mm.
Surface Slope() {
  Surface surface;
  surface.sensor_width_px = 600;
  surface.sensor_height_px = 400;
  for (int row = 50; row < 250; ++row) {
    for (int col = 100; col < 500; ++col) {
      const float depth = 900.0F + 100.0F * static_cast<float>(col - 100) / 399.0F;
      surface.point_in_camera.emplace_back(static_cast<float>(col) * 0.1F, static_cast<float>(row) * 0.1F, depth);
      surface.colour.push_back({200, 160, 140});
      surface.quality.push_back(1);
      surface.col.push_back(static_cast<std::uint16_t>(col));
      surface.row.push_back(static_cast<std::uint16_t>(row));
    }
  }
  return surface;
}

ImageRgb Decode(const Result<std::vector<std::uint8_t>>& png) { return report::DecodePicture(png.value()).value(); }

TEST(DepthPreview, TakesItsRangeFromAllButTheOutermostPoints) {
  Surface surface = Slope();
  surface.point_in_camera[0].z() = 5000;  // a stray point
  const DepthRange range = RobustDepthRange(surface).value();
  EXPECT_NEAR(range.near_mm, 901, 1);  // 1 % of the points lie nearer than 901 mm; rounded outwards
  EXPECT_NEAR(range.far_mm, 999, 1);
}

TEST(DepthPreview, PaintsNearYellowAndFarViolet) {
  const ImageRgb map = Decode(DepthPreview(Slope(), DepthRange{900, 1000}, 600));
  EXPECT_LE(map.width(), 600);
  const int row = map.height() / 3;
  const Rgb8 near = map(12, row);  // the margin of 2 % is 8 px
  EXPECT_GT(near.r, 220);
  EXPECT_LT(near.b, 90);
  const Rgb8 far = map(404, row);
  EXPECT_LT(far.r, 90);
  EXPECT_LT(far.g, 40);
  EXPECT_EQ(map(2, row), (Rgb8{255, 255, 255}));  // no point, no colour
}

TEST(DepthPreview, FitsTheSizeAskedFor) {
  for (const int side : {120, 400, 1200}) {
    const ImageRgb map = Decode(DepthPreview(Slope(), std::nullopt, side));
    EXPECT_LE(map.width(), side);
    EXPECT_LE(map.height(), side);
  }
}

TEST(DepthPreview, IsTheSameForTheSameSurface) {
  EXPECT_EQ(DepthPreview(Slope()).value(), DepthPreview(Slope()).value());
}

TEST(DepthPreview, RefusesWhatHasNoDepth) {
  EXPECT_EQ(DepthPreview(Surface()).error().code, ErrorCode::kMeasurementRefused);
  EXPECT_EQ(ShadedPreview(Surface()).error().code, ErrorCode::kMeasurementRefused);
  EXPECT_EQ(RobustDepthRange(Surface()).error().code, ErrorCode::kMeasurementRefused);
  EXPECT_EQ(DepthPreview(Slope(), DepthRange{5, 5}).error().code, ErrorCode::kUsage);
}

TEST(ShadedPreview, LightsASlopeEvenly) {
  const ImageRgb shaded = Decode(ShadedPreview(Slope(), 400));
  const Rgb8 a = shaded(100, 50), b = shaded(300, 150);
  EXPECT_NEAR(a.r, b.r, 3);  // one plane, one brightness; 8 bits and float normals
  EXPECT_GT(a.r, 40);
  EXPECT_LT(a.r, 239);
}

TEST(PhotographPreview, IsScaledDownToItsLongerSide) {
  const ImageRgb small = Decode(PhotographPreview(ImageRgb(300, 200, {10, 20, 30}), 150));
  EXPECT_EQ(small.width(), 150);
  EXPECT_EQ(small.height(), 100);
  EXPECT_EQ(small(75, 50), (Rgb8{10, 20, 30}));
  EXPECT_EQ(PhotographPreview(ImageRgb()).error().code, ErrorCode::kBadImage);
}

}  // namespace
}  // namespace striae::app
