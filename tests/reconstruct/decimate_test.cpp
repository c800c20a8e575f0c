#include "reconstruct/decimate.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

namespace striae::reconstruct {
namespace {

constexpr double kRadius_mm = 100;

/// The cap of a ball before the camera, one point a pixel and millimetre.
Surface Cap(int half_px = 60) {
  Surface cap;
  cap.sensor_width_px = cap.sensor_height_px = 2 * half_px + 1;
  for (int row = 0; row <= 2 * half_px; ++row) {
    for (int col = 0; col <= 2 * half_px; ++col) {
      const double x = col - half_px, y = row - half_px;
      cap.point_in_camera.emplace_back(
          Eigen::Vector3d(x, y, 1000 - std::sqrt(kRadius_mm * kRadius_mm - x * x - y * y)).cast<float>());
      cap.colour.push_back({static_cast<std::uint8_t>(col), static_cast<std::uint8_t>(row), 9});
      cap.quality.push_back(0.5F);
      cap.col.push_back(static_cast<std::uint16_t>(col));
      cap.row.push_back(static_cast<std::uint16_t>(row));
      if (col == 0 || row == 0) continue;
      const auto here = static_cast<std::uint32_t>(cap.size() - 1),
                 above = here - static_cast<std::uint32_t>(2 * half_px + 1);
      cap.faces.push_back({above - 1, here - 1, above});
      cap.faces.push_back({above, here - 1, here});
    }
  }
  return cap;
}

TEST(Decimate, ABallStaysABall) {
  const Surface cap = Cap();
  const auto few = Decimate(cap, 2000);
  ASSERT_TRUE(few) << few.error().message;
  EXPECT_LE(few->faces.size(), 2000U);
  EXPECT_GT(few->faces.size(), 1900U);
  for (const auto& point : few->point_in_camera) {
    // The sag of triangles of about 5 mm sides on this ball is 0.04 mm; its rim is a saw of one-pixel steps.
    EXPECT_NEAR((point.cast<double>() - Eigen::Vector3d(0, 0, 1000)).norm(), kRadius_mm, 0.15);
  }
  for (const auto& face : few->faces) {
    const Eigen::Vector3f &a = few->point_in_camera[face[0]], &b = few->point_in_camera[face[1]],
                          &c = few->point_in_camera[face[2]];
    EXPECT_LT((b - a).cross(c - a).z(), 0) << "a face looks away from the camera";
  }
}

TEST(Decimate, PointsTakeColourAndPixelFromWhereTheyLie) {
  const Surface cap = Cap();
  const auto few = Decimate(cap, 2000);
  ASSERT_TRUE(few);
  ASSERT_TRUE(few->HasGrid());
  for (std::size_t i = 0; i < few->size(); ++i) {
    // Pixels are a millimetre apart on x and y, and the rim is steep: the nearest point may lie a pixel further.
    EXPECT_NEAR(few->point_in_camera[i].x() + 60, few->col[i], 1.6) << i;
    EXPECT_NEAR(few->point_in_camera[i].y() + 60, few->row[i], 1.6) << i;
    EXPECT_EQ(few->colour[i].r, few->col[i]);
  }
}

TEST(Decimate, TheDeviationIsThatOfTheLeftOutPoints) {
  // A flat sheet whose one raised point is left out: the deviation is its height.
  Surface sheet = Cap(10);
  for (auto& p : sheet.point_in_camera) p.z() = 900;
  Surface flat = sheet;
  sheet.point_in_camera[sheet.size() / 2].z() = 897.5F;
  const auto deviation = DeviationFrom(sheet, flat);
  ASSERT_TRUE(deviation) << deviation.error().message;
  EXPECT_NEAR(deviation->largest_mm, 2.5, 1e-4);
  EXPECT_NEAR(deviation->rms_mm, 2.5 / std::sqrt(441.0), 1e-4);
  const Surface cap = Cap();
  const auto fine = DeviationFrom(cap, *Decimate(cap, 8000)), coarse = DeviationFrom(cap, *Decimate(cap, 300));
  ASSERT_TRUE(fine && coarse);
  EXPECT_LT(fine->largest_mm, coarse->largest_mm);
  EXPECT_LT(coarse->rms_mm, 1);
}

TEST(Decimate, LeavesASmallSurfaceAsItIsAndRefusesNonsense) {
  const Surface cap = Cap(5);
  EXPECT_EQ(Decimate(cap, 1000)->faces, cap.faces);
  EXPECT_EQ(Decimate(cap, 3).error().code, ErrorCode::kUsage);
  Surface points = cap;
  points.faces.clear();
  EXPECT_EQ(Decimate(points, 100).error().code, ErrorCode::kMeasurementRefused);
}

}  // namespace
}  // namespace striae::reconstruct
