#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "analysis/head/detail/cloud.h"

namespace striae::head::detail {
namespace {

/// A wall of 120 mm by 120 mm at 2 m, one point every 0.25 mm; the right half `step_mm` further away.
Surface Wall(double noise_mm, double step_mm) {
  Surface s;
  s.sensor_width_px = s.sensor_height_px = 480;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int row = 0; row < 480; ++row) {
    for (int col = 0; col < 480; ++col) {
      const double z = 2000 + noise_mm * normal(random) + (col >= 244 ? step_mm : 0);
      const Eigen::Vector3d ray((col - 240) * 0.25 / 2000, (row - 240) * 0.25 / 2000, 1);
      s.point_in_camera.push_back((z * ray).cast<float>());
      s.col.push_back(static_cast<std::uint16_t>(col));
      s.row.push_back(static_cast<std::uint16_t>(row));
    }
  }
  return s;
}

TEST(Thinning, KeepsItsSpacingUnderNoiseLargerThanTheGrid) {
  // 120 mm / 2 mm = 60 blocks each way.
  EXPECT_EQ(Thin(Wall(0, 0), 2).size(), 3600U);
  EXPECT_EQ(Thin(Wall(1.0, 0), 2).size(), 3600U);
}

TEST(Thinning, AveragesNoise) {
  double squares = 0;
  const Points points = Thin(Wall(0.8, 0), 2).point;
  for (const auto& p : points) squares += (p.z() - 2000.0) * (p.z() - 2000.0);
  // 64 points a block: 0.8 / 8 = 0.1 mm, known to 1.2 % from 3600 blocks.
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(points.size())), 0.1, 0.01);
}

TEST(Thinning, NeverPutsAPointBetweenTwoSurfaces) {
  // The step runs through the middle of blocks (column 244 of 240..247).
  for (const auto& p : Thin(Wall(0, 50), 2).point) {
    EXPECT_TRUE(std::abs(p.z() - 2000) < 0.01 || std::abs(p.z() - 2050) < 0.01) << p.z();
  }
}

TEST(Thinning, WithoutSensorGridVoxelsDoTheSame) {
  Surface wall = Wall(0, 0);
  wall.col.clear();
  wall.row.clear();
  const auto count = static_cast<double>(Thin(wall, 2).size());
  EXPECT_NEAR(count, 3600, 200);  // voxels of the border are cut
}

}  // namespace
}  // namespace striae::head::detail
