// The surface on the sensor's grid and the lists that it becomes are the same surface.
#include "reconstruct/sensor_surface.h"

#include <vector>

#include <gtest/gtest.h>

#include "core/ply.h"
#include "reconstruct/reconstruct.h"
#include "tests/reconstruct/fringes.h"

namespace striae::reconstruct {
namespace {

using striae::testing::SmallQuarterRig;
using striae::testing::UprightLimb;

const Photograph& Limb() {
  static const Photograph photograph = testing::Render({SmallQuarterRig(), UprightLimb(960, 65)});
  return photograph;
}

SensorSurface OnSensor(bool faces) {
  ReconstructOptions options;
  options.faces = faces;
  auto made = ReconstructOnSensor(Limb(), SmallQuarterRig(), options);
  EXPECT_TRUE(made) << made.error().message;
  return std::move(made->surface);
}

std::vector<std::uint8_t> Streamed(const SensorSurface& surface) {
  std::vector<std::uint8_t> bytes;
  EXPECT_TRUE(surface.EncodePly([&](std::span<const std::uint8_t> piece) {
    bytes.insert(bytes.end(), piece.begin(), piece.end());
    return true;
  }));
  return bytes;
}

TEST(SensorSurface, StreamsTheFileOfItsLists) {
  for (const bool faces : {true, false}) {
    SensorSurface surface = OnSensor(faces);
    surface.comments.insert(surface.comments.begin(), "made for a test");
    const std::vector<std::uint8_t> bytes = Streamed(surface);
    const std::size_t points = surface.points(), triangles = surface.faces(), body = surface.FileBytes();
    ASSERT_GT(points, 10'000U);
    EXPECT_EQ(triangles > points, faces);  // two a pixel, but for the rim
    const auto end = std::string_view("end_header\n");
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    EXPECT_EQ(bytes.size(), text.find(end) + end.size() + body);
    const Surface lists = std::move(surface).ToSurface();
    EXPECT_EQ(lists.size(), points);
    EXPECT_EQ(lists.faces.size(), triangles);
    EXPECT_TRUE(lists.HasGrid());
    EXPECT_EQ(EncodePly(lists), bytes);
  }
}

TEST(SensorSurface, IsWhatReconstructGives) {
  const auto made = Reconstruct(Limb(), SmallQuarterRig(), {});
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(EncodePly(made->surface), Streamed(OnSensor(true)));
}

TEST(SensorSurface, StopsWhenAPieceCannotBeTaken) {
  const SensorSurface surface = OnSensor(true);
  for (const int last : {0, 1, 7, 40}) {
    int taken = 0;
    EXPECT_FALSE(surface.EncodePly([&](std::span<const std::uint8_t>) { return taken++ < last; }));
    EXPECT_EQ(taken, last + 1);
  }
}

TEST(SensorSurface, WithoutAGridIsEmpty) {
  EXPECT_EQ(SensorSurface().points(), 0U);
  EXPECT_EQ(SensorSurface().ToSurface().size(), 0U);
}

}  // namespace
}  // namespace striae::reconstruct
