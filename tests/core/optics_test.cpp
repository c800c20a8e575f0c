#include "core/optics.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

namespace striae {
namespace {

/// Invented rig at about 1 m, with every distortion at work.
Calibration InventedRig() {
  Calibration rig;
  rig.image_width_px = 4288;
  rig.image_height_px = 2848;
  rig.camera = {9560, 9555, 2150.5, 1420.25, -0.06, 0.05, 2e-4, -3e-4};
  rig.projector.center_mm = {3, -118, 42};
  rig.projector.rotation_rodrigues = {0.117, -0.004, 0.006};
  rig.projector.focal_stripes = 521;
  rig.projector.center_order = 69.3;
  rig.projector.k1 = -0.03;
  rig.stripes = 140;
  rig.near_mm = 850;
  rig.far_mm = 1150;
  return rig;
}

Calibration AngularRig() {
  Calibration rig = InventedRig();
  rig.projector = {};
  rig.projector.kind = ProjectorModel::Kind::kAngular;
  rig.projector.center_mm = {0, -120, 40};
  rig.projector.a0_rad = -0.02;
  rig.projector.delta_a_rad = 0.0019;
  return rig;
}

class AnyPoint : public ::testing::Test {
 protected:
  Eigen::Vector3d Draw() {
    const double z = depth_(engine_);
    return {z * across_(engine_), z * along_(engine_), z};
  }
  std::mt19937 engine_{20260504};
  std::uniform_real_distribution<double> depth_{850, 2300}, across_{-0.22, 0.22}, along_{-0.15, 0.15};
};

TEST_F(AnyPoint, ProjectedLiesOnItsOwnRay) {
  const Calibration rig = InventedRig();
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d point = Draw();
    const Eigen::Vector3d back = point.z() * RayOf(rig.camera, Project(rig.camera, point));
    // The inverse distortion iterates to 1e-12 of the normalised coordinate, times up to 2300 mm.
    EXPECT_LT((back - point).norm(), 1e-8);
  }
}

TEST_F(AnyPoint, DepthFromItsOrderIsItsDepth) {
  for (const Calibration& rig : {InventedRig(), AngularRig()}) {
    const StripeOptics optics(rig);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d point = Draw();
      const auto order = optics.OrderAt(point);
      ASSERT_TRUE(order);
      const auto depth = optics.DepthAt(point / point.z(), *order);
      ASSERT_TRUE(depth);
      EXPECT_NEAR(*depth, point.z(), 1e-6);  // fixed point of the projector's k1, 8 steps of factor < 0.01
    }
  }
}

TEST(Optics, DistortionIsOpenCvs) {
  // k1 r2 + k2 r4 and the tangential terms, worked out by hand for (0.2, -0.1): r2 = 0.05.
  const CameraModel camera{1, 1, 0, 0, 0.1, 0.2, 0.01, 0.02};
  const Eigen::Vector2d distorted = Distort(camera, {0.2, -0.1});
  const double radial = 1 + 0.1 * 0.05 + 0.2 * 0.0025;
  EXPECT_NEAR(distorted.x(), 0.2 * radial + 2 * 0.01 * 0.2 * -0.1 + 0.02 * (0.05 + 2 * 0.04), 1e-15);
  EXPECT_NEAR(distorted.y(), -0.1 * radial + 0.01 * (0.05 + 2 * 0.01) + 2 * 0.02 * 0.2 * -0.1, 1e-15);
}

TEST(Optics, AngularModelIsThePapersFormula) {
  // (4) with P_y = 120 upwards, P_z = 40, at 1000 mm on the optical axis: tan a = 120 / 960 downwards.
  Calibration rig = AngularRig();
  rig.projector.a0_rad = std::atan(120.0 / 960.0);
  const auto depth = StripeOptics(rig).DepthAt({0, 0, 1}, 0);
  ASSERT_TRUE(depth);
  EXPECT_NEAR(*depth, 1000, 1e-9);  // with the wrong sign of a it would come out as 668
}

TEST(Optics, OrderGrowsDownTheSensorByAboutAStripeEverySixteenMillimetresOfDepth) {
  const StripeOptics optics(InventedRig());
  EXPECT_LT(*optics.OrderAt({0, -10, 1000}), *optics.OrderAt({0, 10, 1000}));
  // OPTICS: on the axis one stripe is about 16 mm of depth at 1 m; this rig's baseline is 118 of its 100-130 mm.
  EXPECT_NEAR(std::abs(optics.DepthPerStripe({0, 0, 1}, 1000)), 16, 1.5);
}

TEST(Optics, NothingIsLitBehindTheProjectorOrMetBehindTheCamera) {
  const StripeOptics optics(InventedRig());
  EXPECT_FALSE(optics.OrderAt({0, 0, -500}));
  // The light of order -100 rises from a projector above the camera: it never meets the optical axis.
  EXPECT_FALSE(optics.DepthAt({0, 0, 1}, -100));
}

}  // namespace
}  // namespace striae
