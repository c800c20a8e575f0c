// The calibration's solver on phases computed from the geometry: a plate with domes before an invented rig.
#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

#include "core/optics.h"
#include "reconstruct/calibrate/solve.h"

namespace striae::reconstruct {
namespace {

/// A plate of 300 x 260 mm with five domes; 2 mm triangles.
Surface DomedPlate() {
  constexpr int kCols = 151, kRows = 131;
  const Eigen::Vector3d domes[] = {{-90, -70, 40}, {80, -75, 34}, {0, 0, 45}, {-85, 75, 36}, {90, 70, 42}};
  Surface mesh;
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < kCols; ++col) {
      const double x = 2 * (col - 75), y = 2 * (row - 65);
      double z = 0;
      for (const auto& dome : domes) {
        const double r2 = (std::pow(x - dome.x(), 2) + std::pow(y - dome.y(), 2)) / (dome.z() * dome.z());
        if (r2 < 1) z = -20 * std::pow(1 - r2, 2);
      }
      mesh.point_in_camera.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
    }
  }
  for (std::uint32_t row = 0; row + 1 < kRows; ++row) {
    for (std::uint32_t col = 0; col + 1 < kCols; ++col) {
      const std::uint32_t i = row * kCols + col;
      mesh.faces.push_back({i, i + kCols, i + 1});
      mesh.faces.push_back({i + 1, i + kCols, i + kCols + 1});
    }
  }
  return mesh;
}

/// Unlike the nominal rig in every number.
Calibration TrueRig() {
  Calibration rig;
  rig.image_width_px = 4288;
  rig.image_height_px = 2848;
  rig.camera = {9495, 9502, 2128, 1439, -0.04, 0.03, 0, 0};
  rig.projector.center_mm = {3.5, -109, 51};
  rig.projector.rotation_rodrigues = {0.112, 0.004, -0.006};
  rig.projector.focal_stripes = 527;
  rig.projector.center_order = 68.4;
  rig.projector.k1 = -0.02;
  rig.stripes = 140;
  return rig;
}

NominalRig Nominal() {
  NominalRig nominal;
  nominal.image_width_px = 4288;
  nominal.image_height_px = 2848;
  nominal.stripes = 140;
  nominal.first_distance_mm = 900;
  return nominal;
}

CalibrationFit TruePose() {
  CalibrationFit pose;
  pose.camera_from_object =
      (Eigen::AngleAxisd(0.08, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(-0.06, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  pose.object_in_camera_mm = {9, -7, 912};
  pose.slide_direction = Eigen::Vector3d(0.015, -0.02, 1).normalized();
  return pose;
}

constexpr double kPhaseNoise_stripes = 0.01;

std::vector<CalibrationView> Photograph(const ReferenceShape& shape, int photographs, double step_mm) {
  const Calibration rig = TrueRig();
  const StripeOptics optics(rig);
  const CalibrationFit pose = TruePose();
  std::mt19937 engine(17);
  std::normal_distribution<double> noise(0, kPhaseNoise_stripes);
  std::vector<CalibrationView> views;
  for (int v = 0; v < photographs; ++v) {
    CalibrationView view;
    view.position_mm = step_mm * v;
    const double unknown = 3 - 7.0 * v;  // unwrapping starts each photograph at a whole number of its own
    for (int row = 20; row < rig.image_height_px; row += 44) {
      for (int col = 20; col < rig.image_width_px; col += 44) {
        const Eigen::Vector3d ray = RayOf(rig.camera, {static_cast<double>(col), static_cast<double>(row)});
        const auto depth = pose.ReferenceDepth(shape, ray, view.position_mm, false);
        if (!depth) continue;
        const auto order = optics.OrderAt(*depth * ray);
        if (!order || *order < -0.25 || *order > 139.25) continue;
        view.samples.push_back(
            {{static_cast<double>(col), static_cast<double>(row)}, *order + unknown + noise(engine)});
      }
    }
    view.low_edge_order = -0.52 + unknown;
    views.push_back(std::move(view));
  }
  return views;
}

TEST(SolveCalibration, FindsTheRigFromShapeAndStepsAlone) {
  const auto shape = ReferenceShape::FromMesh(DomedPlate());
  ASSERT_TRUE(shape) << shape.error().message;
  const auto fit = SolveCalibration(*shape, Photograph(*shape, 9, 25), Nominal());
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

TEST(SolveCalibration, FindsARigWithVerticalStripes) {
  const auto upright = ReferenceShape::FromMesh(DomedPlate());
  const auto shape = ReferenceShape::FromMesh(Transposed(DomedPlate()));
  ASSERT_TRUE(upright && shape);
  NominalRig nominal = Nominal();
  std::swap(nominal.image_width_px, nominal.image_height_px);
  nominal.direction = StripeDirection::kVertical;
  const auto fit = SolveCalibration(*shape, Transposed(Photograph(*upright, 7, 30)), nominal);
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
  const auto views = Photograph(*shape, 3, 50);
  EXPECT_TRUE(CheckObject(*shape, views[0], Nominal()));
  const Status refused = CheckObject(*wrong, views[0], Nominal());
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, ::testing::HasSubstr("is it the right mesh"));
}

TEST(SolveCalibration, RefusesWhatCannotDetermineTheRig) {
  const auto shape = ReferenceShape::FromMesh(DomedPlate());
  ASSERT_TRUE(shape);
  auto views = Photograph(*shape, 4, 50);
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
