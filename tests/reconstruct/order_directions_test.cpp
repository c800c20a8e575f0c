// Which way the projector stands and the stripes run: what the light shows holds for every rig.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ostream>
#include <stdexcept>

#include <gmock/gmock.h>

#include "core/optics.h"
#include "reconstruct/order.h"
#include "tests/reconstruct/scenes_kinds.h"

namespace striae::reconstruct {
namespace {

using Eigen::Vector3d;
using striae::testing::Body;
using striae::testing::BodyScene;
using striae::testing::DepthOf;
using striae::testing::PhotographOf;
using striae::testing::Placed;

/// Where the projector stands, seen from the camera.
enum class Side { kAbove, kBelow, kLeft, kRight };

/// A rig at 1 m on an eighth of the sensor's pixels: 35 stripes, 9 px each, aimed at the axis at 1 m from 115 mm off
/// it. Stripes run along rows where the projector stands above or below, else along columns.
Calibration Rig(Side side) {
  const bool upright = side == Side::kAbove || side == Side::kBelow;
  constexpr double kOff = 115, kInFront = 45;
  Calibration rig;
  rig.image_width_px = upright ? 536 : 356;
  rig.image_height_px = upright ? 356 : 536;
  rig.camera = {1195, 1195, rig.image_width_px / 2.0, rig.image_height_px / 2.0};
  rig.direction = upright ? StripeDirection::kHorizontal : StripeDirection::kVertical;
  const double sign = side == Side::kAbove || side == Side::kLeft ? -1 : 1, turn = std::atan2(kOff, 1000 - kInFront);
  const Vector3d off = upright ? Vector3d(0, sign * kOff, kInFront) : Vector3d(sign * kOff, 0, kInFront);
  rig.projector.center_mm = off;
  // Its own y axis runs across the stripes: for stripes along columns it is turned about the optical axis as well.
  const Eigen::Matrix3d tilt =
      (upright ? Eigen::AngleAxisd(-sign * turn, Vector3d::UnitX()) : Eigen::AngleAxisd(sign * turn, Vector3d::UnitY()))
          .toRotationMatrix();
  const Eigen::Matrix3d roll = upright ? Eigen::Matrix3d::Identity()
                                       : Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::AngleAxisd turned(Eigen::Matrix3d(roll * tilt));
  rig.projector.rotation_rodrigues = turned.angle() * turned.axis();
  rig.projector.focal_stripes = 130;
  rig.projector.center_order = 17;
  rig.stripes = 35;
  rig.near_mm = 900;
  rig.far_mm = 1100;
  return rig;
}

BodyScene SceneOf(Side side, std::vector<Body> bodies) {
  BodyScene scene;
  scene.rig = Rig(side);
  scene.bodies = std::move(bodies);
  scene.ambient = 0.03;
  return scene;
}

/// A step in depth within three quarters of a stripe, over which the window mixes both surfaces: no whole number is
/// right there.
bool IsOnOutline(const ImageF& depth, int col, int row) {
  constexpr int kReach_px = 7;
  constexpr double kStep_mm = 5;  // what the bodies here slope by over that is less
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int x = col + dx * kReach_px, y = row + dy * kReach_px;
      if (depth.Contains(x, y) && !(std::abs(depth(x, y) - depth(col, row)) < kStep_mm)) return true;
    }
  }
  return false;
}

struct Settled {
  PhaseResult phase;
  std::vector<RegionOrder> orders;
  double right = 0, silent = 0;  ///< shares off outlines: right without a warning, wrong without one
};

Settled Settle(const BodyScene& scene) {
  PhaseOptions options;
  options.direction = scene.rig.direction;
  const Photograph photograph = PhotographOf(scene);
  auto phase = MeasurePhase(photograph, options);
  if (!phase) throw std::runtime_error(phase.error().message);
  Settled settled{*std::move(phase), {}};
  settled.orders = SettleOrder(settled.phase, photograph.colour, scene.rig, 1000);
  const ImageF depth = DepthOf(scene);
  const StripeOptics optics(scene.rig);
  double all = 0;
  for (int row = 0; row < depth.height(); row += 2) {
    for (int col = 0; col < depth.width(); col += 2) {
      const int region = settled.phase.unwrapped.region(col, row);
      if (region < 0 || !std::isfinite(depth(col, row)) || IsOnOutline(depth, col, row)) continue;
      const RegionOrder& order = settled.orders.at(static_cast<std::size_t>(region));
      const auto truth = optics.OrderAt(depth(col, row) *
                                        RayOf(scene.rig.camera, {static_cast<double>(col), static_cast<double>(row)}));
      if (!truth) continue;
      ++all;
      if (order.source == OrderSource::kNone || !order.warning.empty()) continue;
      const double found = settled.phase.unwrapped.phase(col, row) / (2 * std::numbers::pi) + order.offset;
      ++(std::abs(found - *truth) < 0.5 ? settled.right : settled.silent);
    }
  }
  settled.right /= all;
  settled.silent /= all;
  return settled;
}

class EverySide : public ::testing::TestWithParam<Side> {
 protected:
  /// (along the stripes, across them) of the rig as x and y of the camera.
  [[nodiscard]] Vector3d At(double along, double across, double depth) const {
    return Upright() ? Vector3d(along, across, depth) : Vector3d(across, along, depth);
  }
  [[nodiscard]] Vector3d Half(double along, double across) const {
    return Upright() ? Vector3d(along, across, 1) : Vector3d(across, along, 1);
  }
  [[nodiscard]] bool Upright() const { return GetParam() == Side::kAbove || GetParam() == Side::kBelow; }
  [[nodiscard]] Body Wall() const { return Placed(Body::Kind::kSquare, At(0, 0, 1040), Half(170, 300)); }
  /// Depth of one stripe on the axis at this depth, from the geometry.
  [[nodiscard]] double Stripe_mm(double depth) const {
    const StripeOptics optics(Rig(GetParam()));
    return 1 / std::abs(*optics.OrderAt({0, 0, depth + 0.5}) - *optics.OrderAt({0, 0, depth - 0.5}));
  }
};

TEST_P(EverySide, APlateThatShowsBothEndsIsRightInSilence) {
  const Settled settled = Settle(SceneOf(GetParam(), {Wall()}));
  EXPECT_EQ(settled.orders.front().source, OrderSource::kGratingEdge);
  EXPECT_EQ(settled.orders.front().warning, "");
  EXPECT_GT(settled.orders.front().margin, 0.76);  // 1 - 2 times the largest rest that is believed
  EXPECT_GT(settled.right, 0.99);
}

TEST_P(EverySide, ACapBetweenTheTwoEndsIsBridgedInSilence) {
  // A cap that stands out of the wall by half a stripe: its outline bends the order and parts it off. Light goes on
  // from the wall over it to the wall again, so it can hold no step.
  const double out = 0.5 * Stripe_mm(1040), radius = 60;
  const Body ball = Placed(Body::Kind::kBall, At(0, 0, 1040), Vector3d(radius, radius, out));
  const Settled settled = Settle(SceneOf(GetParam(), {Wall(), ball}));
  EXPECT_EQ(settled.silent, 0);
  EXPECT_GT(settled.right, 0.99);  // none of it is warned of
}

TEST_P(EverySide, APlateAWholeStripeNearerIsNeverWrongInSilence) {
  // By a whole stripe in front of the wall, wholly within the field: no phase shows it but its shadow does. Slivers
  // where a part ends beside the shadow stay, up to 0.2 % of this small picture.
  for (const double stripes : {0.95, 1.0, 1.05}) {
    const double depth = 1040 - stripes * Stripe_mm(1025);
    const Body plate = Placed(Body::Kind::kSquare, At(0, 0, depth), Half(60, 45));
    const Settled settled = Settle(SceneOf(GetParam(), {Wall(), plate}));
    EXPECT_LT(settled.silent, 0.0025) << stripes;
    EXPECT_GT(settled.right, 0.5) << stripes;  // the wall beside it is not lost
  }
}

void PrintTo(Side side, std::ostream* out) {
  constexpr std::array<const char*, 4> kNames = {"above", "below", "left of", "right of"};
  *out << "the projector " << kNames[static_cast<std::size_t>(side)] << " the camera";
}

INSTANTIATE_TEST_SUITE_P(OfTheCamera, EverySide,
                         ::testing::Values(Side::kAbove, Side::kBelow, Side::kLeft, Side::kRight));

}  // namespace
}  // namespace striae::reconstruct
