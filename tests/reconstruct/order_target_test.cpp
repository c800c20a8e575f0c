// Labels of known size, printed by OpenCV's drawing of the code and photographed by formulas.
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <opencv2/aruco.hpp>

#include "core/optics.h"
#include "reconstruct/order.h"
#include "tests/reconstruct/scenes_kinds.h"
#include "tests/reconstruct/scenes_render.h"

namespace striae::reconstruct {
namespace {

using Eigen::Vector3d;
using striae::testing::Body;
using striae::testing::BodyScene;
using striae::testing::DepthOf;
using striae::testing::PhotographOf;
using striae::testing::Placed;

constexpr int kMarker = 417;

/// White paper of a sixth of the side around the marker, on a square of 8/6 of the side.
Body Label(const Vector3d& middle, double side_mm, double yaw_deg, double pitch_deg, double roll_deg,
           bool mirrored = false) {
  constexpr double kRad = std::numbers::pi / 180;
  const Eigen::Matrix3d turned =
      (Eigen::AngleAxisd(roll_deg * kRad, Vector3d::UnitZ()) * Eigen::AngleAxisd(yaw_deg * kRad, Vector3d::UnitY()) *
       Eigen::AngleAxisd(pitch_deg * kRad, Vector3d::UnitX()))
          .toRotationMatrix();
  Body body = Placed(Body::Kind::kSquare, middle, {side_mm * 4 / 6, side_mm * 4 / 6, 1}, turned);
  cv::Mat modules;
  cv::aruco::drawMarker(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_1000), kMarker, 6, modules, 1);
  body.albedo = [modules, mirrored](const Vector3d& p) {
    const int col = static_cast<int>(std::floor((mirrored ? -p.x() : p.x()) * 4 + 3)),
              row = static_cast<int>(std::floor(p.y() * 4 + 3));
    const bool printed = col >= 0 && row >= 0 && col < 6 && row < 6;
    return printed && modules.at<std::uint8_t>(row, col) == 0 ? 0.06 : 0.8;
  };
  return body;
}

/// A rig on a quarter of the sensor's pixels and a card too small for the grating's edges, with the label on it.
BodyScene Labelled(bool small, const Body& label) {
  BodyScene scene = striae::testing::MakeOrderScene(small ? "limb" : "head over torso", 7, 0.25).scene;
  Body card = label;
  card.albedo = [](const Vector3d&) { return 0.5; };
  card.camera_from_unit.linear().leftCols<2>() *= small ? 2.5 : 2.0;
  card.camera_from_unit.translation() += Vector3d(0, 0, 0.5);  // just behind the print
  scene.bodies = {card, label};
  return scene;
}

PhaseResult PhaseOf(const BodyScene& scene) {
  PhaseOptions options;
  options.direction = scene.rig.direction;
  auto phase = MeasurePhase(PhotographOf(scene), options);
  if (!phase) throw std::runtime_error(phase.error().message);
  return *std::move(phase);
}

/// The largest region's whole number from the geometry.
int TrueOffset(const BodyScene& scene, const PhaseResult& phase) {
  const ImageF depth = DepthOf(scene);
  const StripeOptics optics(scene.rig);
  std::vector<int> offsets;
  for (int row = 0; row < depth.height(); row += 3) {
    for (int col = 0; col < depth.width(); col += 3) {
      if (phase.unwrapped.region(col, row) != 0) continue;
      const auto order = optics.OrderAt(depth(col, row) *
                                        RayOf(scene.rig.camera, {static_cast<double>(col), static_cast<double>(row)}));
      offsets.push_back(
          static_cast<int>(std::lround(*order - phase.unwrapped.phase(col, row) / (2 * std::numbers::pi))));
    }
  }
  std::nth_element(offsets.begin(), offsets.begin() + static_cast<long>(offsets.size() / 2), offsets.end());
  return offsets[offsets.size() / 2];
}

struct Placement {
  bool small;
  double distance_mm, yaw_deg, pitch_deg, roll_deg;
};

void PrintTo(const Placement& p, std::ostream* out) {
  *out << (p.small ? "40 mm at " : "100 mm at ") << p.distance_mm << " mm, tilted " << p.yaw_deg << ", " << p.pitch_deg
       << ", " << p.roll_deg;
}

class Target : public ::testing::TestWithParam<Placement> {};

TEST_P(Target, GivesTheDistanceAndTheWholeNumber) {
  const Placement& p = GetParam();
  const double side = p.small ? 40 : 100;
  const BodyScene scene = Labelled(p.small, Label({5, -8, p.distance_mm}, side, p.yaw_deg, p.pitch_deg, p.roll_deg));
  const PhaseResult phase = PhaseOf(scene);
  const auto target = FindTarget(phase, scene.rig.camera, side);
  ASSERT_TRUE(target);
  EXPECT_EQ(target->marker_id, kMarker);
  // By its outline alone: 3 standard uncertainties, and those no more than 2 % (a tilt of 11 degrees, which an outline
  // of some 100 px hardly shows, shortens it by so much).
  EXPECT_LT(std::abs(target->middle_mm.z() - p.distance_mm), 3 * target->distance_sd_mm);
  EXPECT_LT(target->distance_sd_mm, 0.02 * p.distance_mm);
  // The expected distance is off by half of the working range: only the label can decide.
  const auto orders = ResolveOrder(phase, scene.rig, scene.rig.near_mm, target);
  EXPECT_EQ(orders.front().source, OrderSource::kTarget);
  EXPECT_EQ(orders.front().offset, TrueOffset(scene, phase));
  EXPECT_EQ(orders.front().warning, "");
}

INSTANTIATE_TEST_SUITE_P(OnABody, Target,
                         ::testing::Values(Placement{true, 985, 0, 0, 0}, Placement{true, 930, 20, -15, 30},
                                           Placement{true, 1040, -15, 10, 150}, Placement{false, 2000, 0, 0, 5},
                                           Placement{false, 1850, -25, 20, -80}));

TEST(TargetRefusal, AHalfHiddenLabelIsNotFound) {
  BodyScene scene = Labelled(true, Label({0, 0, 990}, 40, 0, 0, 0));
  scene.bodies.push_back(Placed(Body::Kind::kSquare, {20, 0, 980}, {14, 60, 1}));
  EXPECT_FALSE(FindTarget(PhaseOf(scene), scene.rig.camera, 40));
}

TEST(TargetRefusal, AMirroredPrintIsNotFound) {
  const BodyScene scene = Labelled(true, Label({0, 0, 990}, 40, 0, 0, 0, true));
  const auto target = FindTarget(PhaseOf(scene), scene.rig.camera, 40);
  EXPECT_TRUE(!target || target->marker_id != kMarker);
}

TEST(TargetRefusal, APhotographWithoutALabelHasNone) {
  const BodyScene scene = striae::testing::MakeOrderScene("limb", 3, 0.25).scene;
  EXPECT_FALSE(FindTarget(PhaseOf(scene), scene.rig.camera, 40));
  PhaseResult dark;
  dark.background = ImageF(300, 200, 0.0F);
  EXPECT_FALSE(FindTarget(dark, scene.rig.camera, 40));
  EXPECT_FALSE(FindTarget(PhaseResult(), scene.rig.camera, 40));
}

TEST(TargetRefusal, AWrongSideLengthOutsideOfTheWorkingRangeIsWarnedOf) {
  const BodyScene scene = Labelled(true, Label({0, 0, 990}, 40, 0, 0, 0));
  const PhaseResult phase = PhaseOf(scene);
  const auto target = FindTarget(phase, scene.rig.camera, 50);  // puts it at 1240 mm
  ASSERT_TRUE(target);
  const auto orders = ResolveOrder(phase, scene.rig, 1000, target);
  EXPECT_THAT(orders.front().warning, ::testing::HasSubstr("side length"));
  EXPECT_EQ(orders.front().margin, 0);
}

TEST(TargetRefusal, AWrongSideLengthIsNotBelievedAgainstTheGratingsEdge) {
  BodyScene scene = Labelled(true, Label({0, 0, 990}, 40, 0, 0, 0));
  scene.bodies.front() = Placed(Body::Kind::kSquare, {0, 0, 990.5}, {60, 400, 1});
  const PhaseResult phase = PhaseOf(scene);
  const int truth = TrueOffset(scene, phase);
  const auto right = FindTarget(phase, scene.rig.camera, 40);
  const auto wrong = FindTarget(phase, scene.rig.camera, 44);
  ASSERT_TRUE(right && wrong);
  const auto agreed = ResolveOrder(phase, scene.rig, 1000, right), torn = ResolveOrder(phase, scene.rig, 1000, wrong);
  EXPECT_EQ(agreed.front().source, OrderSource::kGratingEdge);
  EXPECT_EQ(agreed.front().offset, truth);
  EXPECT_EQ(agreed.front().warning, "");
  EXPECT_THAT(torn.front().warning, ::testing::HasSubstr("disagree"));
  EXPECT_EQ(torn.front().margin, 0);
}

TEST(RegionSummary, ListsTheLargeRegionsAndAddsUpTheSpecks) {
  std::vector<RegionOrder> regions(1003);
  regions[0] = {100000, OrderSource::kGratingEdge, 3, 0.9, ""};
  regions[1] = {5000, OrderSource::kBridge, 3, 0.7, "beside"};
  for (std::size_t i = 2; i < regions.size(); ++i) regions[i] = {50, OrderSource::kNone, 0, 0, "none"};
  regions[1002] = {50, OrderSource::kBridge, 4, 0.5, "beside"};
  const auto summary = SummarisedRegions(regions);
  ASSERT_EQ(summary.size(), 4U);
  EXPECT_EQ(summary[1].points, 5000U);
  EXPECT_EQ(summary[2].source, OrderSource::kBridge);
  EXPECT_EQ(summary[2].points, 50U);
  EXPECT_EQ(summary[3].source, OrderSource::kNone);
  EXPECT_EQ(summary[3].points, 50000U);
  EXPECT_EQ(summary[3].regions, 1000);
}

}  // namespace
}  // namespace striae::reconstruct
