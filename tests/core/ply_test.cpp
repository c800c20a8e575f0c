#include "core/ply.h"

#include <algorithm>
#include <cstring>
#include <string>

#include <gmock/gmock.h>

namespace striae {
namespace {

/// Two triangles on four neighbouring pixels.
Surface Patch() {
  Surface surface;
  surface.sensor_width_px = 20;
  surface.sensor_height_px = 10;
  for (int i = 0; i < 4; ++i) {
    surface.point_in_camera.emplace_back(static_cast<float>(i % 2), static_cast<float>(i / 2), 1000.5F);
    surface.colour.push_back({static_cast<std::uint8_t>(i), 128, 255});
    surface.quality.push_back(0.25F * static_cast<float>(i));
    surface.col.push_back(static_cast<std::uint16_t>(5 + i % 2));
    surface.row.push_back(static_cast<std::uint16_t>(7 + i / 2));
  }
  surface.faces = {{0, 2, 1}, {1, 2, 3}};
  surface.comments = {"calibration 00ff"};
  return surface;
}

std::vector<std::uint8_t> Bytes(const std::string& text) { return {text.begin(), text.end()}; }

TEST(Ply, SurvivesWritingAndReading) {
  const Surface patch = Patch();
  const auto back = DecodePly(EncodePly(patch));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->point_in_camera, patch.point_in_camera);
  EXPECT_EQ(back->colour, patch.colour);
  EXPECT_EQ(back->quality, patch.quality);
  EXPECT_EQ(back->col, patch.col);
  EXPECT_EQ(back->row, patch.row);
  EXPECT_EQ(back->faces, patch.faces);
  EXPECT_EQ(back->comments, patch.comments);
  EXPECT_EQ(back->sensor_width_px, 20);
  EXPECT_EQ(VertexIndexGrid(*back)(6, 8), 3);
  EXPECT_EQ(VertexIndexGrid(*back)(0, 0), -1);
}

TEST(Ply, HeaderIsTheContracts) {
  const auto bytes = EncodePly(Patch());
  const std::string text(bytes.begin(), bytes.end());
  EXPECT_THAT(text, ::testing::StartsWith("ply\nformat binary_little_endian 1.0\n"));
  EXPECT_THAT(text, ::testing::HasSubstr("element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                                         "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                                         "property float quality\nproperty ushort col\nproperty ushort row\n"));
}

TEST(Ply, ReadsAsciiWithOtherPropertiesAndPolygons) {
  const auto surface = DecodePly(
      Bytes("ply\nformat ascii 1.0\nelement vertex 4\nproperty double nx\nproperty double x\nproperty double y\n"
            "property double z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
            "0 0 0 5\n0 1 0 5\n0 1 1 5\n0 0 1 5\n4 0 1 2 3\n"));
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->point_in_camera[2], Eigen::Vector3f(1, 1, 5));
  EXPECT_EQ(surface->faces.size(), 2U);
  EXPECT_FALSE(surface->HasGrid());
}

TEST(Ply, EveryTruncationIsAnErrorAndNeverASmallerSurface) {
  const auto bytes = EncodePly(Patch());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(DecodePly({bytes.data(), size})) << size;
  }
}

TEST(Ply, RefusesWhatCannotBe) {
  const std::string vertices = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_index\n";
  for (const std::string& text :
       {std::string("ply\nformat binary_big_endian 1.0\n") + vertices + "end_header\n000011112222",
        std::string("ply\nformat ascii 1.0\n") + vertices + "end_header\n0 0 nan\n",
        std::string("ply\nformat ascii 1.0\n") + vertices + faces + "end_header\n0 0 1\n3 0 0 1\n",
        std::string("ply\nformat ascii 1.0\n") + vertices + faces + "end_header\n0 0 1\n3 0 0 -1\n",
        std::string("ply\nformat ascii 1.0\nelement vertex 18446744073709551615\nproperty float x\nend_header\n0\n"),
        std::string("ply\n") + vertices + "end_header\n", std::string("solid x\n")}) {
    EXPECT_FALSE(DecodePly(Bytes(text))) << text;
  }
}

TEST(Stl, HoldsEveryTriangleWithItsNormalTowardsTheCamera) {
  const auto bytes = EncodeStl(Patch(), "solid but binary");
  ASSERT_EQ(bytes.size(), 84U + 2 * 50);
  EXPECT_NE(std::string(bytes.begin(), bytes.begin() + 5), "solid");
  std::uint32_t count = 0;
  float normal_z = 0;
  std::memcpy(&count, &bytes[80], 4);
  std::memcpy(&normal_z, &bytes[84 + 8], 4);
  EXPECT_EQ(count, 2U);
  EXPECT_EQ(normal_z, -1);  // the camera looks along +z
}

}  // namespace
}  // namespace striae
