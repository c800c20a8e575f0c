#include "report/picture.h"

#include <gtest/gtest.h>

#include "report/drawing.h"

namespace striae::report {
namespace {

ImageRgb Ramp(int width, int height) {
  ImageRgb image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      image(x, y) = {static_cast<std::uint8_t>(2 * x), static_cast<std::uint8_t>(3 * y), 7};
  }
  return image;
}

TEST(Picture, ComesBackFromPngUnchanged) {
  const ImageRgb image = Ramp(60, 40);
  const auto back = DecodePicture(EncodePng(image).value());
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->width(), 60);
  EXPECT_EQ(back->pixels(), image.pixels());
}

TEST(Picture, ComesBackFromJpegNearlyUnchanged) {
  const ImageRgb image = Ramp(60, 40);
  const auto back = DecodePicture(EncodeJpeg(image, 95).value());
  ASSERT_TRUE(back.has_value());
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) EXPECT_NEAR((*back)(x, y).r, image(x, y).r, 12);  // quantisation and half-size chroma
  }
}

TEST(Picture, ThatIsDamagedIsRefused) {
  const auto refused = [](std::vector<std::uint8_t> bytes) { return !DecodePicture(bytes).has_value(); };
  EXPECT_TRUE(refused({}));
  EXPECT_TRUE(refused({'h', 'e', 'l', 'l', 'o'}));
  EXPECT_TRUE(refused({0xFF, 0xD8, 0xFF, 0xE0, 0, 1}));
  auto png = EncodePng(Ramp(60, 40)).value();
  png.resize(png.size() / 2);
  EXPECT_TRUE(refused(png));
  // A header that promises 2^31 pixels a side asks for no memory.
  auto huge = EncodePng(Ramp(4, 4)).value();
  huge[16] = huge[20] = 0x7F;
  EXPECT_TRUE(refused(huge));
  EXPECT_FALSE(EncodePng(ImageRgb()).has_value());
  EXPECT_FALSE(EncodeJpeg(ImageRgb(), 90).has_value());
}

TEST(Picture, ShrinksByTheMeanOfWholeAreas) {
  ImageRgb image(4, 2);
  for (int x = 0; x < 4; ++x) image(x, 0) = image(x, 1) = {static_cast<std::uint8_t>(60 * x), 0, 100};
  const ImageRgb small = ShrinkToFit(image, 2, 2);
  ASSERT_EQ(small.width(), 2);
  ASSERT_EQ(small.height(), 1);
  EXPECT_EQ(small(0, 0), (Rgb8{30, 0, 100}));
  EXPECT_EQ(small(1, 0), (Rgb8{150, 0, 100}));
}

TEST(Picture, KeepsItsMeanWhenTheSizesDoNotDivide) {
  const ImageRgb image = Ramp(100, 70);  // mean of red 99, of green 103.5
  const ImageRgb small = ShrinkToFit(image, 33, 33);
  EXPECT_EQ(small.width(), 33);
  EXPECT_EQ(small.height(), 23);
  double red = 0, green = 0;
  for (const Rgb8& pixel : small.pixels()) {
    red += pixel.r;
    green += pixel.g;
  }
  EXPECT_NEAR(red / static_cast<double>(small.size()), 99, 0.5);  // rounding to whole levels
  EXPECT_NEAR(green / static_cast<double>(small.size()), 103.5, 0.5);
}

TEST(Picture, IsNeverEnlarged) { EXPECT_EQ(ShrinkToFit(Ramp(60, 40), 600, 600).pixels(), Ramp(60, 40).pixels()); }

TEST(Drawing, NamesItsNamespaceInAFileOfItsOwnOnly) {
  // Without it a viewer shows the file as text; a report must not name any address.
  Drawing drawing;
  drawing.width = drawing.height = 10;
  const std::string name_space = " xmlns=\"http://www.w3.org/2000/svg\"";
  EXPECT_EQ(SvgFile(drawing), "<svg" + name_space + ToSvg(drawing).substr(4));
  EXPECT_EQ(ToSvg(drawing).find("xmlns"), std::string::npos);
}

}  // namespace
}  // namespace striae::report
