// What must never come out as an angle: other people, other things, and photographs that were not taken as they should.
#include <cmath>
#include <functional>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/head/angles.h"
#include "analysis/head/measure.h"
#include "tests/head/bust.h"

namespace striae::head {
namespace {

using ::testing::AnyOf;
using testing::Bust;
using ::testing::HasSubstr;
using testing::SeenFromTheFront;

constexpr double kNoiseMm = 0.2;  // left on a surface at 2 m after the Fourier stage's smoothing

using Change = std::function<Eigen::Vector3f(const Eigen::Vector3f&)>;

Surface Changed(Surface surface, const Change& change) {
  for (auto& p : surface.point_in_camera) p = change(p);
  // As reconstruction states it; without, 0.3 mm are taken for each point.
  surface.uncertainty_mm.resize(surface.size());
  for (auto& u : surface.uncertainty_mm) u = static_cast<float>(kNoiseMm);
  return surface;
}

Eigen::Vector3f Same(const Eigen::Vector3f& p) { return p; }

/// Nobody is symmetric: a smooth bulge of 2 mm and a shoulder lower by 6 mm, on the body before it is seen.
Eigen::Vector3f Lopsided(const Eigen::Vector3f& p) {
  Eigen::Vector3f q = p;
  q.z() -= 2.5F * std::sin(p.x() / 45) * std::cos(p.y() / 60) + 3.0F * std::sin(p.x() / 120);
  return q;
}

const Surface& Neutral() {
  static const Surface surface = Changed(SeenFromTheFront({}, kNoiseMm, 1), Same);
  return surface;
}

const Surface& Turned() {
  static const Surface surface = [] {
    Bust bust;
    bust.head_rotation = Compose({Angle::Degrees(12), Angle::Degrees(5), Angle::Degrees(-4), {}});
    return SeenFromTheFront(bust, kNoiseMm, 2);
  }();
  return surface;
}

void ExpectRefused(const Result<AnalysisReport>& result, const ::testing::Matcher<const std::string&>& why) {
  ASSERT_FALSE(result) << ToJson(*result).dump();
  EXPECT_EQ(result.error().code, ErrorCode::kMeasurementRefused);
  EXPECT_THAT(result.error().Describe(), why);
}

TEST(HeadBadCapture, TheSamePersonIsMeasured) {
  EXPECT_TRUE(Measure(Neutral(), Changed(Turned(), Same)));
  EXPECT_TRUE(Measure(Changed(Neutral(), Lopsided), Changed(Turned(), Lopsided)));
}

class Strangers : public ::testing::TestWithParam<Eigen::Vector3f> {};

TEST_P(Strangers, AreRefused) {
  // Adults' chest breadths and head lengths have a standard deviation of about 6 % of their mean.
  const Eigen::Vector3f stretch = GetParam(), middle(10, -60, 2000);
  const auto other = [&](const Eigen::Vector3f& p) -> Eigen::Vector3f {
    return middle + stretch.cwiseProduct(p - middle);
  };
  const Surface pose = Changed(Turned(), other);
  ExpectRefused(Measure(Neutral(), pose), AnyOf(HasSubstr("different person"), HasSubstr("same person")));
}

INSTANTIATE_TEST_SUITE_P(All, Strangers,
                         // Broader, narrower, and taller with a flatter chest.
                         ::testing::Values(Eigen::Vector3f(1.06F, 1, 1), Eigen::Vector3f(0.94F, 1, 1),
                                           Eigen::Vector3f(1, 1.06F, 0.94F)));

TEST(HeadBadCapture, AMirroredPhotographIsRefused) {
  const Surface neutral = Changed(Neutral(), Lopsided);
  const Surface mirrored = Changed(Changed(Turned(), Lopsided),
                                   [](const Eigen::Vector3f& p) { return Eigen::Vector3f(20 - p.x(), p.y(), p.z()); });
  ExpectRefused(Measure(neutral, mirrored), HasSubstr("mirror"));
  ExpectRefused(Measure(mirrored, neutral), HasSubstr("mirror"));
}

TEST(HeadBadCapture, APhotographHeldSidewaysIsRefused) {
  const auto quarter = [](const Eigen::Vector3f& p) { return Eigen::Vector3f(-p.y(), p.x(), p.z()); };
  const Surface sideways = Changed(Turned(), quarter);
  ExpectRefused(Measure(Neutral(), sideways), HasSubstr("of the neutral capture"));
  ExpectRefused(Measure(sideways, Neutral()), HasSubstr("must show head, bare neck and shoulders"));
}

TEST(HeadBadCapture, TheSmallRangesCalibrationIsRefused) {
  // 0.9 m instead of 2 m: everything less than half its size.
  const auto shrink = [](const Eigen::Vector3f& p) -> Eigen::Vector3f { return 0.45F * p; };
  const Surface small = Changed(Turned(), shrink);
  ExpectRefused(Measure(Neutral(), small), HasSubstr("of the neutral capture"));
  ExpectRefused(Measure(Changed(Neutral(), shrink), small),
                AnyOf(HasSubstr("mm wide"), HasSubstr("no head"), HasSubstr("too few"), HasSubstr("too little")));
}

TEST(HeadBadCapture, AScarfOverTheChestIsRefused) {
  // Folds of 12 mm that fall anew for every photograph, from the chin down to the lower chest.
  const auto scarf = [](float phase) {
    return [phase](const Eigen::Vector3f& p) {
      if (p.y() < -95 || p.y() > 240) return p;
      const float fold = 20 + 12 * std::sin(p.x() / 14 + phase) * std::cos(p.y() / 22 + 2 * phase);
      return Eigen::Vector3f(p * (1 - fold / p.norm()));
    };
  };
  ExpectRefused(Measure(Changed(Neutral(), scarf(0)), Changed(Turned(), scarf(2))), HasSubstr("torso"));
  ExpectRefused(Measure(Neutral(), Changed(Turned(), scarf(1))), HasSubstr("torso"));
}

/// A sheet of 700 x 500 mm at 2 m with a point every 4 mm, `depth_mm` over (x, y) nearer; NaN where there is nothing.
Surface Sheet(const std::function<float(float, float)>& depth_mm) {
  Surface s;
  s.sensor_width_px = 175;
  s.sensor_height_px = 125;
  for (int row = 0; row < 125; ++row) {
    for (int col = 0; col < 175; ++col) {
      const float x = 4 * static_cast<float>(col - 87), y = 4 * static_cast<float>(row - 62), d = depth_mm(x, y);
      if (!std::isfinite(d)) continue;
      s.point_in_camera.push_back(Eigen::Vector3f(x / 2000, y / 2000, 1) * (2000 - d));
      s.col.push_back(static_cast<std::uint16_t>(col));
      s.row.push_back(static_cast<std::uint16_t>(row));
    }
  }
  return s;
}

TEST(HeadBadCapture, WithoutAHeadIsRefused) {
  const Surface wall = Sheet([](float, float) { return 0.F; });
  const Surface limb = Sheet([](float x, float) { return std::abs(x) < 60 ? std::sqrt(3600 - x * x) : NAN; });
  const Surface lying_limb = Sheet([](float, float y) { return std::abs(y) < 60 ? std::sqrt(3600 - y * y) : NAN; });
  for (const Surface* s : {&wall, &limb, &lying_limb}) {
    ExpectRefused(Measure(*s, *s), HasSubstr("must show head, bare neck and shoulders"));
    ExpectRefused(Measure(Neutral(), *s), HasSubstr("torso of the neutral capture"));
  }
}

TEST(HeadBadCapture, ARefusalTellsWhatTheReconstructionDoubts) {
  Surface wall = Sheet([](float, float) { return 0.F; });
  wall.comments.push_back(WarningComment("region of 400000 pixels: its whole stripe number may be wrong"));
  ExpectRefused(Measure(Neutral(), wall),
                HasSubstr("the other capture's reconstruction warns: region of 400000 pixels"));
}

}  // namespace
}  // namespace striae::head
