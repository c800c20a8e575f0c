#include "reconstruct/reconstruct.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

#include "core/optics.h"
#include "tests/reconstruct/fringes.h"

namespace striae::reconstruct {
namespace {

using striae::testing::FringeScene;
using striae::testing::LargeQuarterRig;
using striae::testing::Plane;
using striae::testing::Render;
using striae::testing::SmallQuarterRig;
using striae::testing::TrueDepth;
using striae::testing::UprightLimb;

struct DepthError {
  double mean = 0, sd = 0, share = 0;  ///< mm, mm, share of the points with a truth
};

DepthError Compare(const Surface& surface, const ImageF& truth) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const float z = truth(surface.col[i], surface.row[i]);
    if (!std::isnan(z)) errors.push_back(surface.point_in_camera[i].z() - z);
  }
  DepthError error;
  for (const double e : errors) error.mean += e / static_cast<double>(errors.size());
  for (const double e : errors) error.sd += std::pow(e - error.mean, 2) / static_cast<double>(errors.size());
  error.sd = std::sqrt(error.sd);
  error.share = static_cast<double>(errors.size()) / static_cast<double>(surface.size());
  return error;
}

TEST(Reconstruct, AnUprightLimbAtOneMetreFromTheGratingsEdge) {
  const FringeScene scene{SmallQuarterRig(), UprightLimb(960, 65)};
  const auto result = Reconstruct(Render(scene), scene.rig, {});
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->regions.front().source, OrderSource::kGratingEdge);
  const DepthError error = Compare(result->surface, TrueDepth(scene));
  // A quarter-size sensor has a stripe every 64 mm of depth: 0.01 stripe of phase error, the paper's class, is 0.64 mm.
  EXPECT_LT(error.sd, 0.64);
  EXPECT_LT(std::abs(error.mean), 0.2);
  EXPECT_GT(result->coverage, 0.9);
}

TEST(Reconstruct, ATiltedWallAtTwoMetresFromTheExpectedDistance) {
  Calibration rig = LargeQuarterRig();
  rig.stripes.reset();  // without the number of stripes nothing but the distance can tell the order
  const FringeScene scene{rig, Plane(2000, 0.1, -0.15)};
  const auto result = Reconstruct(Render(scene), scene.rig, {});
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->regions.front().source, OrderSource::kDistance);
  const DepthError error = Compare(result->surface, TrueDepth(scene));
  // A stripe is about 270 mm of depth for this rig: 0.01 stripe.
  EXPECT_LT(error.sd, 2.7);
  EXPECT_LT(std::abs(error.mean), 2.7);
}

TEST(Reconstruct, KeepsMoreOfWhatMisfitsWhereAStripeIsLittleDepth) {
  // Two millimetres: where a stripe is 130 mm deep, that is no more than any phase's own limit.
  const ReconstructOptions options;
  EXPECT_EQ(MostMisfitInside(LargeQuarterRig(), options), PhaseOptions{}.most_misfit);
  const Calibration rig = SmallQuarterRig();
  const double middle_mm = (rig.near_mm + rig.far_mm) / 2;
  const StripeOptics optics(rig);
  const auto order = [&](double depth_mm) { return *optics.OrderAt({0, 0, depth_mm}); };
  const double stripe_mm = 1 / std::abs(order(middle_mm + 0.5) - order(middle_mm - 0.5));
  const double misfit = 2 * std::numbers::pi * std::numbers::sqrt2 * 2 / stripe_mm;
  EXPECT_GT(misfit, 1.5 * PhaseOptions{}.most_misfit);
  EXPECT_NEAR(MostMisfitInside(rig, options), misfit, 1e-3 * misfit);
  ReconstructOptions strict;
  strict.most_misfit_mm = 0;
  EXPECT_EQ(MostMisfitInside(SmallQuarterRig(), strict), PhaseOptions{}.most_misfit);
}

TEST(Reconstruct, PointsLieOnTheirPixelsRays) {
  const FringeScene scene{SmallQuarterRig(), UprightLimb(960, 65)};
  const auto result = Reconstruct(Render(scene), scene.rig, {});
  ASSERT_TRUE(result) << result.error().message;
  const Surface& surface = result->surface;
  for (std::size_t i = 0; i < surface.size(); i += 997) {
    const Eigen::Vector2d pixel = Project(scene.rig.camera, surface.point_in_camera[i].cast<double>());
    EXPECT_NEAR(pixel.x(), surface.col[i], 1e-3);  // float coordinates of 1000 mm: 6e-5 mm
    EXPECT_NEAR(pixel.y(), surface.row[i], 1e-3);
  }
}

TEST(Reconstruct, FacesLookAtTheCameraAndNeverBridgeAStep) {
  // A near limb before a wall far behind it.
  const auto limb = UprightLimb(900, 50);
  const auto wall = Plane(1100, 0, 0);
  const FringeScene scene{SmallQuarterRig(), [=](const Eigen::Vector3d& ray) {
                            const auto near = limb(ray);
                            return near ? near : wall(ray);
                          }};
  const auto result = Reconstruct(Render(scene), scene.rig, {});
  ASSERT_TRUE(result) << result.error().message;
  const Surface& surface = result->surface;
  ASSERT_FALSE(surface.faces.empty());
  for (const auto& face : surface.faces) {
    const Eigen::Vector3f &a = surface.point_in_camera[face[0]], &b = surface.point_in_camera[face[1]],
                          &c = surface.point_in_camera[face[2]];
    EXPECT_LE((b - a).cross(c - a).dot(a), 0);
    EXPECT_LT(std::max({a.z(), b.z(), c.z()}) - std::min({a.z(), b.z(), c.z()}), 20);
  }
}

TEST(Reconstruct, ColourHasNoStripesLeft) {
  const FringeScene scene{SmallQuarterRig(), Plane(1000, 0, 0, 120, 1e4)};
  const auto result = Reconstruct(Render(scene), scene.rig, {});
  ASSERT_TRUE(result) << result.error().message;
  // On a uniform wall the stripes would swing between 0.05 and 1 of the light; what is left is noise and shading.
  double sum = 0, squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < result->surface.size(); ++i) {
    if (std::abs(result->surface.row[i] - 356) > 100 || std::abs(result->surface.col[i] - 536) > 100) continue;
    sum += result->surface.colour[i].g;
    squares += std::pow(result->surface.colour[i].g, 2);
    ++count;
  }
  const double mean = sum / static_cast<double>(count);
  EXPECT_GT(mean, 150);  // the bright stripes' value, not the mean of bright and dark
  EXPECT_LT(std::sqrt(squares / static_cast<double>(count) - mean * mean), 0.03 * mean);
}

TEST(Reconstruct, AmbiguousOrderIsNeverSilent) {
  // A plate smaller than the stripe field: its ends are the subject's own, and at 1 m the distance cannot tell.
  Calibration rig = SmallQuarterRig();
  rig.projector.focal_stripes *= 4;  // as many stripes as the real grating: 16 mm of depth each
  rig.projector.center_order = 69.3;
  rig.stripes = 140;
  rig.camera.fx *= 2;  // twice the magnification, so that the finer stripes are still resolved
  rig.camera.fy *= 2;
  const FringeScene scene{rig, Plane(984, 0, 0, 60, 40)};
  const auto result = Reconstruct(Render(scene), scene.rig, {});
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_NE(result->regions.front().source, OrderSource::kGratingEdge);
  ASSERT_FALSE(result->warnings.empty());
  EXPECT_THAT(result->warnings.front(), ::testing::HasSubstr("--distance-mm"));
}

TEST(Reconstruct, SameBytesEveryTime) {
  const FringeScene scene{SmallQuarterRig(), UprightLimb(960, 65)};
  const Photograph photograph = Render(scene);
  const auto first = Reconstruct(photograph, scene.rig, {}), second = Reconstruct(photograph, scene.rig, {});
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->surface.point_in_camera, second->surface.point_in_camera);
  EXPECT_EQ(first->surface.faces, second->surface.faces);
  EXPECT_EQ(first->surface.colour, second->surface.colour);
}

TEST(Reconstruct, RefusesAPhotographThatIsNotTheCalibrations) {
  const FringeScene scene{SmallQuarterRig(), UprightLimb(960, 65)};
  Calibration other = scene.rig;
  other.image_width_px += 8;
  const auto result = Reconstruct(Render(scene), other, {});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kCalibrationMismatch);
  EXPECT_THAT(result.error().message, ::testing::HasSubstr("1080 x 712"));
}

TEST(Reconstruct, WarnsOfSaturation) {
  FringeScene scene{SmallQuarterRig(), UprightLimb(960, 65)};
  scene.albedo = [](const Eigen::Vector3d& point) { return point.y() > 20 ? 2.5 : 0.6; };
  const auto result = Reconstruct(Render(scene), scene.rig, {});
  ASSERT_TRUE(result) << result.error().message;
  ASSERT_FALSE(result->warnings.empty());
  EXPECT_THAT(result->warnings.front(), ::testing::HasSubstr("saturated"));
}

}  // namespace
}  // namespace striae::reconstruct
