#include "core/stl.h"

#include <cstring>
#include <limits>
#include <string>

#include <gmock/gmock.h>

namespace striae {
namespace {

/// Two triangles on four neighbouring pixels, looking at the camera.
Surface Patch() {
  Surface surface;
  for (int i = 0; i < 4; ++i) {
    surface.point_in_camera.emplace_back(static_cast<float>(i % 2), static_cast<float>(i / 2), 1000.5F);
    surface.colour.push_back({});
    surface.quality.push_back(1);
  }
  surface.faces.push_back({0, 2, 1});
  surface.faces.push_back({1, 2, 3});
  return surface;
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

TEST(Stl, SurvivesWritingAndReading) {
  const Surface patch = Patch();
  const auto back = DecodeStl(EncodeStl(patch, "x"));
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_EQ(back->size(), 4U);  // six corners are four places
  ASSERT_EQ(back->faces.size(), 2U);
  for (std::size_t face = 0; face < 2; ++face) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      EXPECT_EQ(back->point_in_camera[back->faces[face][corner]], patch.point_in_camera[patch.faces[face][corner]]);
    }
  }
}

TEST(Stl, RefusesWhatIsCutOrNotFinite) {
  auto bytes = EncodeStl(Patch(), "x");
  for (const std::size_t size : {std::size_t{0}, std::size_t{80}, std::size_t{84}, bytes.size() - 1}) {
    EXPECT_FALSE(DecodeStl({bytes.data(), size})) << size;
  }
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(&bytes[84 + 12], &nan, 4);
  EXPECT_FALSE(DecodeStl(bytes));
  const std::uint32_t lie = 0xffffffff;
  std::memcpy(&bytes[80], &lie, 4);
  EXPECT_FALSE(DecodeStl(bytes));
}

}  // namespace
}  // namespace striae
