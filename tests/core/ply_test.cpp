#include "core/ply.h"

#include <algorithm>
#include <cstring>
#include <limits>
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

TEST(Ply, KeepsTheUncertaintyOfEachPoint) {
  Surface patch = Patch();
  patch.uncertainty_mm.assign({0.1F, 0.2F, 0.3F, 0.4F});
  const auto back = DecodePly(EncodePly(patch));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->uncertainty_mm, patch.uncertainty_mm);
  EXPECT_TRUE(DecodePly(EncodePly(Patch()))->uncertainty_mm.empty());
  for (const float none : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -0.1F}) {
    patch.uncertainty_mm[2] = none;
    const auto refused = DecodePly(EncodePly(patch));
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, ::testing::HasSubstr("uncertainty of vertex 2"));
  }
}

TEST(Ply, ASurfaceWithoutColoursIsWrittenGrey) {
  Surface bare = Patch();
  bare.colour.clear();
  bare.quality.clear();
  const auto back = DecodePly(EncodePly(bare));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->point_in_camera, bare.point_in_camera);
  // What a file without colours and modulation is read as.
  EXPECT_EQ(back->colour, Buffer<Rgb8>(4, Rgb8{200, 200, 200}));
  EXPECT_EQ(back->quality, Buffer<float>(4, 1.0F));
}

/// More points and faces than two pieces hold, so that both threads work.
Surface LargeSheet() {
  Surface sheet;
  sheet.sensor_width_px = 500;
  sheet.sensor_height_px = 400;
  for (std::uint32_t i = 0; i < 200'000; ++i) {
    const auto col = static_cast<std::uint16_t>(i % 500), row = static_cast<std::uint16_t>(i / 500);
    sheet.point_in_camera.emplace_back(col, row, 1000.0F + 0.001F * static_cast<float>(i));
    sheet.colour.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8), 7});
    sheet.quality.push_back(1 / (1 + static_cast<float>(i)));
    sheet.col.push_back(col);
    sheet.row.push_back(row);
    if (i >= 501) sheet.faces.push_back({i, i - 1, i - 500});
  }
  return sheet;
}

TEST(Ply, InPiecesIsTheSameFile) {
  const Surface sheet = LargeSheet();
  std::vector<std::uint8_t> joined;
  std::size_t pieces = 0, largest = 0;
  EXPECT_TRUE(EncodePly(sheet, [&](std::span<const std::uint8_t> piece) {
    joined.insert(joined.end(), piece.begin(), piece.end());
    ++pieces;
    largest = std::max(largest, piece.size());
    return true;
  }));
  EXPECT_GT(pieces, 6U);
  EXPECT_LT(largest, joined.size() / 3);  // never the file as a whole
  EXPECT_EQ(joined, EncodePly(sheet));
  const auto back = DecodePly(joined);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->point_in_camera, sheet.point_in_camera);
  EXPECT_EQ(back->quality, sheet.quality);
  EXPECT_EQ(back->faces, sheet.faces);
}

TEST(Ply, StopsWhenThePiecesCannotBeTaken) {
  const Surface sheet = LargeSheet();
  for (int last = 0; last < 5; ++last) {
    int taken = 0;
    EXPECT_FALSE(EncodePly(sheet, [&](std::span<const std::uint8_t>) { return taken++ < last; }));
    EXPECT_EQ(taken, last + 1);
  }
}

}  // namespace
}  // namespace striae
