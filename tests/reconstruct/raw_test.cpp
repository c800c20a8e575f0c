// Raw files through the real decoder: linear light, in the geometry of the camera's own JPEG.
#include <cmath>

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

#include "app/io/photograph.h"
#include "tests/support/dng.h"

namespace striae::app {
namespace {

using striae::testing::DngOptions;
using striae::testing::MakeDng;

TEST(RawPhotograph, IsLinearLightOfTheSensorsGeometry) {
  DngOptions options{.width = 200, .height = 120};
  // Light grows along the row; orientation 6 in the file asks for a turn that is not made.
  const auto photograph =
      DecodePhotograph(MakeDng(options, [](int col, int, int) { return static_cast<std::uint16_t>(40 * col); }));
  ASSERT_TRUE(photograph) << photograph.error().message;
  EXPECT_TRUE(photograph->linear);
  ASSERT_EQ(photograph->luminance.width(), 200);
  ASSERT_EQ(photograph->luminance.height(), 120);
  for (int col = 10; col < 190; col += 9) {
    // 16 bits over a white level of 16383; bilinear interpolation keeps a ramp.
    EXPECT_NEAR(photograph->luminance(col, 60), 40.0 * col / 16383, 2e-4) << col;
  }
  const double half = 40.0 * 100 / 16383;  // sRGB's encoding of it is what the colour shows
  EXPECT_NEAR(photograph->colour(100, 60).g, 255 * (1.055 * std::pow(half, 1 / 2.4) - 0.055), 2);
  EXPECT_NEAR(photograph->colour(100, 60).r, photograph->colour(100, 60).g, 3);
}

TEST(RawPhotograph, FullPixelsAreSaturatedAndOthersAreNot) {
  const auto photograph = DecodePhotograph(MakeDng({.width = 200, .height = 120}, [](int col, int, int channel) {
    return static_cast<std::uint16_t>(col < 100 ? 8000 : channel == 1 ? 16383 : 9000);
  }));
  ASSERT_TRUE(photograph) << photograph.error().message;
  EXPECT_LT(photograph->luminance(50, 60), photograph->saturation_level);
  EXPECT_GE(photograph->luminance(150, 60), photograph->saturation_level);  // green alone is full
}

/// Blotches that look alike nowhere.
double Blotch(double col, double row) {
  return 0.5 + 0.2 * std::sin(col / 5.3) * std::cos(row / 7.1) + 0.2 * std::sin((col * 1.7 + row) / 23.0) +
         0.05 * std::sin(col * row / 900.0);
}

TEST(RawPhotograph, IsCutToWhereTheEmbeddedJpegLies) {
  constexpr int kLeft = 9, kTop = 4, kWidth = 280, kHeight = 190;
  cv::Mat jpeg(kHeight, kWidth, CV_8UC3);
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      const double encoded = 1.055 * std::pow(Blotch(col + kLeft, row + kTop), 1 / 2.4) - 0.055;
      jpeg.at<cv::Vec3b>(row, col) = cv::Vec3b::all(static_cast<uchar>(std::lround(255 * encoded)));
    }
  }
  DngOptions options{.width = 300, .height = 200};
  cv::imencode(".jpg", jpeg, options.preview_jpeg);
  options.preview_width = kWidth;
  options.preview_height = kHeight;
  const auto photograph = DecodePhotograph(
      MakeDng(options, [](int col, int row, int) { return static_cast<std::uint16_t>(16383 * Blotch(col, row)); }));
  ASSERT_TRUE(photograph) << photograph.error().message;
  ASSERT_EQ(photograph->luminance.width(), kWidth);
  ASSERT_EQ(photograph->luminance.height(), kHeight);
  EXPECT_EQ(photograph->colour.width(), kWidth);
  for (int row = 5; row < kHeight; row += 37) {
    for (int col = 5; col < kWidth; col += 31) {
      // Interpolation between the pixels of one colour rounds the blotches a little; a pixel off would be 0.04.
      EXPECT_NEAR(photograph->luminance(col, row), Blotch(col + kLeft, row + kTop), 0.01);
    }
  }
}

TEST(RawPhotograph, OfAD90HasTheGeometryOfItsJpegs) {
  DngOptions options{.width = 4352, .height = 2868};
  options.make = "NIKON CORPORATION";
  options.model = "NIKON D90";
  const auto photograph =
      DecodePhotograph(MakeDng(options, [](int, int row, int) { return static_cast<std::uint16_t>(5 * row); }));
  ASSERT_TRUE(photograph) << photograph.error().message;
  EXPECT_EQ(photograph->luminance.width(), 4288);
  EXPECT_EQ(photograph->luminance.height(), 2848);
  EXPECT_NEAR(photograph->luminance(2000, 1000), 5.0 * (1000 + 10) / 16383, 2e-4);  // ten rows are cut above
}

TEST(RawPhotograph, TruncatedIsAnError) {
  auto bytes = MakeDng({.width = 200, .height = 120}, [](int, int, int) { return std::uint16_t{900}; });
  // The directory stands at the end: moved to the front by cutting the sensor's data out of the middle.
  for (const double share : {0.02, 0.5, 0.95}) {
    const auto size = static_cast<std::size_t>(share * static_cast<double>(bytes.size()));
    EXPECT_FALSE(DecodePhotograph({bytes.data(), size})) << share;
  }
}

}  // namespace
}  // namespace striae::app
