#include "core/obj.h"

#include <gmock/gmock.h>

namespace striae {
namespace {

using ::testing::HasSubstr;

/// Two triangles on four pixels in the middle of a small sensor.
Surface Patch() {
  Surface surface;
  surface.sensor_width_px = 20;
  surface.sensor_height_px = 10;
  for (int i = 0; i < 4; ++i) {
    surface.point_in_camera.emplace_back(-0.25F * static_cast<float>(i % 2), static_cast<float>(i / 2), 1000.5F);
    surface.colour.push_back({static_cast<std::uint8_t>(60 * i), 128, 255});
    surface.quality.push_back(1);
    surface.col.push_back(static_cast<std::uint16_t>(5 + i % 2));
    surface.row.push_back(static_cast<std::uint16_t>(7 + i / 2));
  }
  surface.faces.push_back({0, 2, 1});
  surface.faces.push_back({1, 2, 3});
  return surface;
}

TEST(Obj, SurvivesWritingAndReading) {
  const Surface patch = Patch();
  for (const char* mtl : {"", "patch.mtl"}) {
    const auto back = DecodeObj(EncodeObj(patch, mtl));
    ASSERT_TRUE(back) << back.error().message;
    ASSERT_EQ(back->size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
      // Four decimals are written: half a tenth of a micrometre.
      EXPECT_LT((back->point_in_camera[i] - patch.point_in_camera[i]).norm(), 1e-4) << i;
    }
    EXPECT_EQ(back->faces, patch.faces);
  }
}

TEST(Obj, TextureCoordinatesAreTheCentresOfTheSensorsPixels) {
  const std::string text = EncodeObj(Patch(), "patch.mtl");
  EXPECT_THAT(text, HasSubstr("mtllib patch.mtl\n"));
  EXPECT_THAT(text, HasSubstr("vt 0.275000 0.250000\n"));  // (5 + 0.5) / 20, 1 - (7 + 0.5) / 10
  EXPECT_THAT(text, HasSubstr("usemtl photograph\nf 1/1 3/3 2/2\n"));
  EXPECT_THAT(EncodeMtl("patch.jpg"), HasSubstr("map_Kd patch.jpg\n"));
}

TEST(Obj, TheTextureHasThePointsColoursAndAMarginOfThem) {
  const Surface patch = Patch();
  const ImageRgb texture = TextureOf(patch, 1);
  ASSERT_EQ(texture.width(), 20);
  ASSERT_EQ(texture.height(), 10);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(texture(patch.col[i], patch.row[i]), patch.colour[i]);
  EXPECT_EQ(texture(4, 7), patch.colour[0]);
  EXPECT_EQ(texture(7, 8), patch.colour[3]);
  EXPECT_EQ(texture(0, 0), (Rgb8{90, 128, 255}));  // the mean
}

TEST(Obj, ReadsPolygonsAndIndicesFromTheEnd) {
  const auto surface =
      DecodeObj("# x\nv 0 0 1\r\nv 1 0 1\nvn 0 0 1\nv 1 1 1\nv 0 1 1\ng a\nf -4//1 -3//1 -2//1 -1//1\n");
  ASSERT_TRUE(surface) << surface.error().message;
  ASSERT_EQ(surface->faces.size(), 2U);
  EXPECT_EQ(surface->faces[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
}

TEST(Obj, RefusesWhatIsNone) {
  for (const char* text : {"", "hello", "v 0 0\n", "v 0 0 nan\n", "v 0 0 1\nf 1 1 2\n", "v 0 0 1\nf 0 1 1\n",
                           "v 0 0 1\nf 1 1\n", "v 0 0 1\nf 1 1 99999999999999999999\n", "v 1 2 x\n"}) {
    EXPECT_FALSE(DecodeObj(text)) << text;
  }
}

}  // namespace
}  // namespace striae
