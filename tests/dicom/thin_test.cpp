// Thinning: few faces, a stated deviation that is the true one, and cuts that stay cuts.
#include "dicom/thin.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/dicom/samples.h"

namespace striae::dicom::testing {
namespace {

TEST(Thinning, LeavesASmallSurfaceAlone) {
  const Surface surface = MakeSphere(20, 15, 300);
  const auto thinned = ThinSurface(surface);
  ASSERT_TRUE(thinned);
  EXPECT_EQ(thinned->step, 1);
  EXPECT_EQ(thinned->surface.faces, surface.faces);
  EXPECT_EQ(thinned->deviation_max_mm, 0);
}

TEST(Thinning, GivesAtMostTheFacesAllowed) {
  const Surface surface = MakeSphere(121, 91, 300);  // 21600 faces
  for (const std::size_t most : {21599U, 5400U, 1000U, 100U}) {
    const auto thinned = ThinSurface(surface, most);
    ASSERT_TRUE(thinned) << most;
    EXPECT_LE(thinned->surface.faces.size(), most);
    EXPECT_GT(thinned->surface.faces.size(), 0U);
    for (const auto& face : thinned->surface.faces) {
      EXPECT_LT(std::max({face[0], face[1], face[2]}), thinned->surface.size());
    }
  }
}

TEST(Thinning, StatesTheSagittaOfASphere) {
  // Between kept points d apart a sphere of radius r bulges by d^2 / (2 r) at most: the sagitta over the diagonal of a
  // k x k block, half of which is k / sqrt 2, is k^2 / (4 r). Here 1 pixel is 1 mm at the nearest point and up to 4 %
  // more at the rim of the view, where the surface is also inclined: 15 % are allowed upwards.
  const double radius_mm = 400;
  const auto thinned = ThinSurface(MakeSphere(121, 91, radius_mm), 21600 / 36);
  ASSERT_TRUE(thinned);
  const double k = thinned->step, sagitta_mm = k * k / (4 * radius_mm);
  EXPECT_EQ(thinned->step, 6);
  EXPECT_GT(thinned->deviation_max_mm, 0.95 * sagitta_mm);
  EXPECT_LT(thinned->deviation_max_mm, 1.15 * sagitta_mm);
  EXPECT_LT(thinned->deviation_p95_mm, thinned->deviation_max_mm);
  EXPECT_GT(thinned->deviation_p95_mm, 0.5 * sagitta_mm);
}

TEST(Thinning, ACutStaysACut) {
  // Columns from 37 on lie 50 mm deeper and no face leads there; 37 is no multiple of the step.
  const auto thinned = ThinSurface(MakeSphere(121, 91, 300, 37, 50.0), 21600 / 16);
  ASSERT_TRUE(thinned);
  for (const auto& face : thinned->surface.faces) {
    const bool near_side = thinned->surface.col[face[0]] < 37;
    for (const auto vertex : face) EXPECT_EQ(thinned->surface.col[vertex] < 37, near_side);
  }
  // No triangle spans the cut, so no deviation is near 50 mm; what lies in the cut's blocks is said to be uncovered.
  EXPECT_LT(thinned->deviation_max_mm, 1.0);
  EXPECT_GT(thinned->uncovered_share, 0.01);
  EXPECT_LT(thinned->uncovered_share, 0.06);
}

TEST(Thinning, ASingleMissingPixelMakesNoHole) {
  Surface surface = MakeSphere(41, 31, 300);
  const std::uint32_t gone = 14 * 41 + 18;  // not a kept pixel, whatever the step
  std::erase_if(surface.faces,
                [gone](const auto& face) { return std::find(face.begin(), face.end(), gone) != face.end(); });
  const auto thinned = ThinSurface(surface, 2400 / 25);
  ASSERT_TRUE(thinned);
  EXPECT_EQ(thinned->surface.faces.size(), 2U * (40 / thinned->step) * (30 / thinned->step));
}

TEST(Thinning, FacesStillLookAtTheCamera) {
  const auto thinned = ThinSurface(MakeSphere(121, 91, 300), 1000);
  ASSERT_TRUE(thinned);
  for (const auto& face : thinned->surface.faces) {
    const auto& p = thinned->surface.point_in_camera;
    const Eigen::Vector3f normal = (p[face[1]] - p[face[0]]).cross(p[face[2]] - p[face[0]]);
    EXPECT_LT(normal.dot(p[face[0]]), 0);
  }
}

TEST(Thinning, RefusesWhatItCannotThin) {
  Surface no_faces = MakeSphere(20, 15, 300);
  no_faces.faces.clear();
  EXPECT_EQ(ThinSurface(no_faces).error().code, ErrorCode::kMeasurementRefused);
  Surface no_pixels = MakeSphere(20, 15, 300);
  no_pixels.col.clear();
  EXPECT_EQ(ThinSurface(no_pixels, 100).error().code, ErrorCode::kUsage);
}

}  // namespace
}  // namespace striae::dicom::testing
