// The calibration's solver on phases computed from the geometry: a plate with domes before an invented rig.
#include <cmath>

#include <gmock/gmock.h>

#include "core/optics.h"
#include "tests/reconstruct/calibration_scene.h"

namespace striae::reconstruct {
namespace {

using testing::DomedPlate;
using testing::kPhaseNoise_stripes;
using testing::Nominal;
using testing::PhotographPlate;
using testing::TrueRig;

TEST(SolveCalibration, FindsTheRigFromShapeAndStepsAlone) {
  const auto shape = ReferenceShape::FromMesh(DomedPlate());
  ASSERT_TRUE(shape) << shape.error().message;
  const auto fit = SolveCalibration(*shape, PhotographPlate(*shape, 9, 25), Nominal());
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_TRUE(fit->order_is_absolute);
  EXPECT_NEAR(fit->sd_stripes, kPhaseNoise_stripes, 0.1 * kPhaseNoise_stripes);
  const Calibration rig = TrueRig();
  // OPTICS: the proof gave the projector's centre and the focal lengths to about 0.2 %.
  EXPECT_NEAR(fit->calibration.camera.fy, rig.camera.fy, 0.002 * rig.camera.fy);
  EXPECT_NEAR(fit->calibration.projector.center_mm.y(), rig.projector.center_mm.y(), 0.5);
  EXPECT_NEAR(fit->calibration.projector.focal_stripes, rig.projector.focal_stripes, 0.002 * 527);

  // What counts: the depth of points that took no part, across the field and the range.
  const StripeOptics truth(rig), found(fit->calibration);
  for (const double z : {920.0, 1000.0, 1100.0}) {
    for (const double x : {500.0, 2100.0, 3700.0}) {
      for (const double y : {400.0, 1400.0, 2400.0}) {
        const auto order = truth.OrderAt(z * RayOf(rig.camera, {x, y}));
        const auto depth = found.DepthAt(RayOf(fit->calibration.camera, {x, y}), *order);
        ASSERT_TRUE(depth);
        EXPECT_NEAR(*depth, z, 1.0) << x << ", " << y;  // within OPTICS' 2 mm of absolute distance, by half
      }
    }
  }
}

/// The same scene seen by a rig that lies on its side: x and y change places everywhere. Reflecting turns a rotation
/// vector about its axis and backwards.
Surface Transposed(Surface mesh) {
  for (auto& point : mesh.point_in_camera) std::swap(point.x(), point.y());
  for (auto& face : mesh.faces) std::swap(face[1], face[2]);
  return mesh;
}

std::vector<CalibrationView> Transposed(std::vector<CalibrationView> views) {
  for (auto& view : views) {
    for (auto& sample : view.samples) std::swap(sample.pixel.x(), sample.pixel.y());
  }
  return views;
}

TEST(SolveCalibrationLong, FindsARigWithVerticalStripes) {
  const auto upright = ReferenceShape::FromMesh(DomedPlate());
  const auto shape = ReferenceShape::FromMesh(Transposed(DomedPlate()));
  ASSERT_TRUE(upright && shape);
  NominalRig nominal = Nominal();
  std::swap(nominal.image_width_px, nominal.image_height_px);
  nominal.direction = StripeDirection::kVertical;
  const auto fit = SolveCalibration(*shape, Transposed(PhotographPlate(*upright, 7, 30)), nominal);
  ASSERT_TRUE(fit) << fit.error().message;
  const Calibration rig = TrueRig();
  EXPECT_EQ(fit->calibration.direction, StripeDirection::kVertical);
  EXPECT_NEAR(fit->calibration.camera.fx, rig.camera.fy, 0.002 * rig.camera.fy);
  EXPECT_NEAR(fit->calibration.projector.center_mm.x(), rig.projector.center_mm.y(), 0.5);
  const StripeOptics truth(rig), found(fit->calibration);
  for (const double z : {920.0, 1060.0}) {
    for (const double x : {500.0, 3700.0}) {
      const auto order = truth.OrderAt(z * RayOf(rig.camera, {x, 900}));
      const auto depth = found.DepthAt(RayOf(fit->calibration.camera, {900, x}), *order);
      ASSERT_TRUE(depth);
      EXPECT_NEAR(*depth, z, 1.0);  // as for horizontal stripes
    }
  }
}

TEST(SolveCalibration, RefusesAnotherObjectAtOnce) {
  const auto shape = ReferenceShape::FromMesh(DomedPlate());
  Surface other = DomedPlate();
  for (auto& point : other.point_in_camera) {  // ripples of the same height instead of domes
    point.z() = -10 - 10 * std::sin(point.x() / 12) * std::cos(point.y() / 15);
  }
  const auto wrong = ReferenceShape::FromMesh(other);
  ASSERT_TRUE(shape && wrong);
  const auto views = PhotographPlate(*shape, 3, 50);
  EXPECT_TRUE(CheckObject(*shape, views[0], Nominal()));
  const Status refused = CheckObject(*wrong, views[0], Nominal());
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, ::testing::HasSubstr("is it the right mesh"));
}

TEST(SolveCalibrationLong, RefusesPositionsThatAreNotThePhotographs) {
  const auto shape = ReferenceShape::FromMesh(DomedPlate());
  ASSERT_TRUE(shape);
  const auto views = PhotographPlate(*shape, 6, 40);
  auto reversed = views;
  for (std::size_t v = 0; v < views.size(); ++v) reversed[v].position_mm = views[views.size() - 1 - v].position_mm;
  auto swapped = views;
  std::swap(swapped[2].position_mm, swapped[4].position_mm);
  auto inches = views;
  for (auto& view : inches) view.position_mm *= 0.394;  // read off the wrong scale
  for (const auto& wrong : {reversed, swapped, inches}) {
    const auto refused = SolveCalibration(*shape, wrong, Nominal());
    ASSERT_FALSE(refused) << "sd " << refused->sd_stripes << ", fy " << refused->calibration.camera.fy;
    EXPECT_EQ(refused.error().code, ErrorCode::kBadCalibration);
  }
}

TEST(SolveCalibration, RefusesWhatCannotDetermineTheRig) {
  const auto shape = ReferenceShape::FromMesh(DomedPlate());
  ASSERT_TRUE(shape);
  auto views = PhotographPlate(*shape, 4, 50);
  EXPECT_FALSE(SolveCalibration(*shape, {views[0], views[1]}, Nominal())) << "two photographs";
  auto standing = views;
  for (auto& view : standing) view.position_mm = 0.1 * static_cast<double>(&view - standing.data());
  EXPECT_FALSE(SolveCalibration(*shape, standing, Nominal())) << "a slide that hardly moves";
  auto wrong_step = views;
  wrong_step[2].position_mm += 8;  // half a stripe's worth of depth: a slip of the pen in the steps file
  const auto refused = SolveCalibration(*shape, wrong_step, Nominal());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kBadCalibration);
}

TEST(ReferenceShape, RefusesMeshesWithoutRelief) {
  Surface flat = DomedPlate();
  for (auto& point : flat.point_in_camera) point.z() = 0;
  EXPECT_FALSE(ReferenceShape::FromMesh(flat));
  Surface points = DomedPlate();
  points.faces.clear();
  EXPECT_FALSE(ReferenceShape::FromMesh(points));
}

TEST(ReferenceShape, InterpolatesItsMesh) {
  const auto shape = ReferenceShape::FromMesh(DomedPlate());
  ASSERT_TRUE(shape);
  EXPECT_NEAR(shape->At(0, 0)->z, -20, 0.02);  // the grid's nodes miss the vertex by up to 0.1 mm
  EXPECT_NEAR(shape->At(-140, 0)->z, 0, 1e-6);
  EXPECT_FALSE(shape->At(200, 0));
}

}  // namespace
}  // namespace striae::reconstruct
