// Shapes, labels, blur and motion of the virtual rig, against geometry written out here.
#include <cmath>
#include <complex>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>

#include "acquire/rig/ball.h"
#include "acquire/rig/blocks.h"
#include "acquire/rig/bust.h"
#include "acquire/rig/default_rig.h"
#include "acquire/rig/label.h"
#include "acquire/rig/plane.h"
#include "acquire/rig/render.h"
#include "core/optics.h"

namespace striae::rig {
namespace {

Calibration IdealCamera(double scale) {
  Calibration rig = ScaleSensor(DefaultRig(Range::kSmall).calibration, scale);
  rig.camera.k1 = rig.camera.k2 = rig.camera.p1 = rig.camera.p2 = 0;
  return rig;
}

Eigen::Vector3d IdealRay(const CameraModel& camera, double col, double row) {
  return {(col - camera.cx) / camera.fx, (row - camera.cy) / camera.fy, 1};
}

RenderOptions RoomLightOnly() {
  RenderOptions options;
  options.sensor.noise = false;
  options.light.flash = 0;
  options.light.ambient = 0.8;
  return options;
}

TEST(Ball, DepthIsTheSpheres) {
  const Calibration rig = IdealCamera(0.1);
  const BallOptions ball{{12, -9, 1060}, 60, 0.6};
  const auto made = Render(*MakeBall(ball), rig, {});
  ASSERT_TRUE(made) << made.error().Describe();
  int compared = 0;
  for (int row = 0; row < rig.image_height_px; ++row) {
    for (int col = 0; col < rig.image_width_px; ++col) {
      const Eigen::Vector3d ray = IdealRay(rig.camera, col, row);
      const double b = ray.dot(ball.center_mm), a = ray.squaredNorm();
      const double root = b * b - a * (ball.center_mm.squaredNorm() - ball.radius_mm * ball.radius_mm);
      if (root < 0.02 * b * b / 100) continue;  // the rim: facets of 0.4 mm end the ball a little earlier
      // Chords lie up to 5e-6 of the radius inside of the sphere; along a slanted ray ten times that.
      EXPECT_NEAR(made->depth_mm(col, row), (b - std::sqrt(root)) / a, 0.004);
      ++compared;
    }
  }
  EXPECT_GT(compared, 5000);
}

TEST(Order, IsTheFormulaOfThePaperForAnAngularProjectorEitherWay) {
  for (const StripeDirection direction : {StripeDirection::kHorizontal, StripeDirection::kVertical}) {
    Calibration rig = IdealCamera(0.1);
    const bool rows = direction == StripeDirection::kHorizontal;
    rig.direction = direction;
    rig.projector = {};
    rig.projector.kind = ProjectorModel::Kind::kAngular;
    rig.projector.center_mm = rows ? Eigen::Vector3d(0, -110, 40) : Eigen::Vector3d(-110, 0, 40);
    rig.projector.delta_a_rad = 0.0019;
    rig.projector.a0_rad = std::atan(110.0 / 960) - 70 * 0.0019;
    const auto made = Render(MakePlane({}), rig, {});
    ASSERT_TRUE(made) << made.error().Describe();
    int lit = 0;
    for (int row = 3; row < rig.image_height_px; row += 17) {
      for (int col = 3; col < rig.image_width_px; col += 17) {
        if (made->lit(col, row) == 0) continue;
        const Eigen::Vector3d point = 1000 * IdealRay(rig.camera, col, row);
        const double angle = std::atan(((rows ? point.y() : point.x()) + 110) / 960);
        EXPECT_NEAR(made->order(col, row), (angle - rig.projector.a0_rad) / rig.projector.delta_a_rad, 1e-4);
        ++lit;
      }
    }
    EXPECT_GT(lit, 100);
  }
}

TEST(Label, IsFoundWhereItsCornersAre) {
  const Calibration rig = IdealCamera(0.25);
  PlaneOptions wall;
  wall.tilt_y_deg = 20;
  TriangleMesh mesh = MakePlane(wall);
  const auto truth = PaintLabel({523, 50, 30, -20, 12}, mesh);
  ASSERT_TRUE(truth) << truth.error().Describe();
  for (int i = 0; i < 4; ++i) {  // on a plane every side has its length, and the corners lie in it
    const Eigen::Vector3d& corner = truth->corner_in_camera[static_cast<std::size_t>(i)];
    EXPECT_NEAR((corner - truth->corner_in_camera[static_cast<std::size_t>((i + 1) % 4)]).norm(), 50, 1e-6);
    EXPECT_NEAR(PlaneNormal(wall).dot(corner - Eigen::Vector3d(0, 0, wall.distance_mm)), 0, 1e-6);
  }
  const auto made = Render(mesh, rig, RoomLightOnly());
  ASSERT_TRUE(made);
  cv::Mat grey(rig.image_height_px, rig.image_width_px, CV_8U);
  for (int row = 0; row < grey.rows; ++row) {
    for (int col = 0; col < grey.cols; ++col) grey.at<std::uint8_t>(row, col) = made->photograph(col, row).g;
  }
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
  cv::aruco::detectMarkers(grey, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_1000), corners, ids,
                           parameters);
  ASSERT_EQ(ids, std::vector<int>{523});
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d& corner = truth->corner_in_camera[i];
    // The refinement finds corners to a few tenths of a pixel; the wrong corner is 100 px away.
    EXPECT_NEAR(corners[0][i].x, rig.camera.fx * corner.x() / corner.z() + rig.camera.cx, 0.5);
    EXPECT_NEAR(corners[0][i].y, rig.camera.fy * corner.y() / corner.z() + rig.camera.cy, 0.5);
  }
}

TEST(Label, RefusesWhatIsNotThere) {
  TriangleMesh mesh = MakePlane({});
  EXPECT_EQ(PaintLabel({1000, 50, 0, 0}, mesh).error().code, ErrorCode::kUsage) << "no such marker";
  EXPECT_EQ(PaintLabel({1, 50, 900, 0}, mesh).error().code, ErrorCode::kUsage) << "beside the plate";
  EXPECT_EQ(PaintLabel({1, 50, 390, 0}, mesh).error().code, ErrorCode::kUsage) << "over its edge";
  EXPECT_TRUE(mesh.decal.empty());
}

/// Amplitude of the stripes' fundamental down one column, by the order that the renderer reports.
double Fundamental(const Rendering& made, int col) {
  std::complex<double> sum = 0;
  int rows = 0;
  for (int row = 0; row < made.order.height(); ++row) {
    const double n = made.order(col, row);
    if (!(n > 20 && n < 120)) continue;
    const double x = made.photograph(col, row).g / 255.0;
    const double linear = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    sum += linear * std::polar(1.0, -2 * std::numbers::pi * n);
    ++rows;
  }
  return std::abs(sum) / rows;
}

TEST(Defocus, LowersTheStripesByTheGaussianOfTheDisc) {
  const Calibration rig = IdealCamera(0.5);
  PlaneOptions far;
  far.distance_mm = 1150;
  RenderOptions sharp, grating, lens;
  sharp.sensor.noise = grating.sensor.noise = lens.sensor.noise = false;
  grating.light.aperture_mm = 4.5;
  grating.light.focus_mm = 960;
  lens.sensor.aperture_mm = 50.0 / 11;
  const int col = rig.image_width_px / 2;
  const double in_focus = Fundamental(*Render(MakePlane(far), rig, sharp), col);
  const double to_projector_mm = (Eigen::Vector3d(0, 0, 1150) - rig.projector.center_mm).norm();
  const double disc_stripes = 4.5 * rig.projector.focal_stripes * (1 / 960.0 - 1 / to_projector_mm);
  const double period_px = rig.camera.fy * (1150 - 44.7) / 1150 / rig.projector.focal_stripes;
  const double disc_px = 50.0 / 11 * rig.camera.fx * (1 / 1000.0 - 1 / 1150.0);
  const auto damping = [](double disc) { return std::exp(-2 * std::pow(std::numbers::pi * disc / 4, 2)); };
  ASSERT_LT(damping(disc_stripes), 0.9) << "enough to be seen";
  // The grating's distance changes over the picture by some per cent, and with it the disc.
  EXPECT_NEAR(Fundamental(*Render(MakePlane(far), rig, grating), col) / in_focus, damping(disc_stripes), 0.03);
  EXPECT_NEAR(Fundamental(*Render(MakePlane(far), rig, lens), col) / in_focus, damping(disc_px / period_px), 0.03);
}

TEST(Motion, SmearsAnEdgeOverItsWay) {
  const Calibration rig = IdealCamera(0.25);
  PlaneOptions card;
  card.half_size_mm = 40;
  RenderOptions moving = RoomLightOnly();
  constexpr double kWay_px = 8;
  moving.motion_mm = {1000 * kWay_px / rig.camera.fx, 0, 0};
  const auto made = Render(MakePlane(card), rig, moving);
  ASSERT_TRUE(made);
  const double edge = rig.camera.cx - rig.camera.fx * 40 / 1000;
  const int row = static_cast<int>(rig.camera.cy);
  const auto linear = [&](int col) { return std::pow(made->photograph(col, row).g / 255.0, 2.2); };
  const double full = linear(static_cast<int>(edge + 20));
  double area = 0;  // of the ramp: what is lit before the edge, half of the way times half of the light on average
  for (int col = static_cast<int>(std::floor(edge)) - 12; col < edge - 0.5; ++col) area += linear(col) / full;
  EXPECT_NEAR(area, kWay_px / 8, 0.25);  // within a pixel's share of the edge's place
  EXPECT_GT(linear(static_cast<int>(edge - 2)), 0.1 * full);
  EXPECT_LT(linear(static_cast<int>(edge - 6)), 0.02 * full);
  EXPECT_NEAR(made->depth_mm(static_cast<int>(edge + 2), row), 1000, 0.01) << "truth is the middle of the exposure";
}

TEST(Blocks, FacesStandAtTheirHeights) {
  const Calibration rig = IdealCamera(0.1);
  const BlocksOptions blocks;
  auto mesh = MakeBlocks(blocks);
  ASSERT_TRUE(mesh);
  Move(Eigen::Matrix3d::Identity(), {0, 0, 1000}, *mesh);
  const auto made = Render(*mesh, rig, {});
  ASSERT_TRUE(made);
  for (std::size_t i = 0; i < blocks.heights_mm.size(); ++i) {
    const double z = 1000 - blocks.heights_mm[i], x = -120 + 80.0 * static_cast<double>(i);
    const int col = static_cast<int>(std::lround(rig.camera.cx + rig.camera.fx * x / z));
    const int row = static_cast<int>(std::lround(rig.camera.cy));
    if (col < 0 || col >= rig.image_width_px) continue;
    EXPECT_NEAR(made->depth_mm(col, row), z, 1e-3) << "block " << i;
  }
  BlocksOptions crowded;
  crowded.block_mm = 80;
  EXPECT_EQ(MakeBlocks(crowded).error().code, ErrorCode::kUsage);
}

TEST(Dress, DarkClothHairAndAnArmChangeWhatTheyCoverOnly) {
  BustOptions plain, dressed;
  dressed.shirt = Shirt::kDark;
  dressed.arm = true;
  const Calibration rig = ScaleSensor(DefaultRig(Range::kLarge).calibration, 0.1);
  RenderOptions far;
  far.light.reference_mm = 2000;
  far.sensor.noise = false;
  const auto bare = Render(MakeBust(plain), rig, far), covered = Render(MakeBust(dressed), rig, far);
  ASSERT_TRUE(bare && covered);
  int nearer = 0, darker = 0, same = 0;
  for (std::size_t i = 0; i < bare->depth_mm.size(); ++i) {
    const float before = bare->depth_mm.pixels()[i], after = covered->depth_mm.pixels()[i];
    if (std::isnan(before)) continue;
    nearer += after < before - 40;
    const int was = bare->photograph.pixels()[i].g, is = covered->photograph.pixels()[i].g;
    darker += after == before && was > 60 && is < 0.6 * was;
    same += after == before && was == is && was > 60;
  }
  EXPECT_GT(nearer, 1000) << "the arm, well before the chest";
  EXPECT_GT(darker, 1000) << "the shirt";
  EXPECT_GT(same, 1000) << "face and neck";
}

}  // namespace
}  // namespace striae::rig
