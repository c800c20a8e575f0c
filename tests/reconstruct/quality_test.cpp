// What is wrong with a photograph although stripes are found in it.
#include "reconstruct/quality.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "tests/reconstruct/fringes.h"

namespace striae::reconstruct {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

testing::FringeScene Wall() { return {testing::SmallQuarterRig(), testing::Plane(1000, 0.05, 0.1)}; }

PhotographQuality Judge(const testing::FringeScene& scene) {
  const Photograph photograph = testing::Render(scene);
  const auto phase = MeasurePhase(photograph);
  if (!phase) throw std::runtime_error(phase.error().message);
  return JudgePhotograph(photograph, *phase);
}

TEST(Quality, AGoodPhotographHasNothingWrong) {
  const PhotographQuality quality = Judge(Wall());
  EXPECT_THAT(quality.warnings, IsEmpty());
  EXPECT_GT(quality.modulation, 0.6);
  EXPECT_LT(quality.second_pattern_share, 0.05);
}

TEST(Quality, ALimbsCurvatureIsNoSecondPattern) {
  EXPECT_THAT(Judge({testing::SmallQuarterRig(), testing::UprightLimb(960, 65)}).warnings, IsEmpty());
}

TEST(Quality, StripedClothIsSaid) {
  // Stripes of cloth along the grating's: light and dark by 40 %, one for every 1.6 of the grating's.
  testing::FringeScene scene = Wall();
  scene.albedo = [](const Eigen::Vector3d& p) {
    constexpr double kGratingStripe_mm = 260.0 / 140 * 4;  // the quarter rig's stripes are four times as wide
    return 0.5 * (1 + 0.4 * std::sin(2 * std::numbers::pi * p.y() / (1.6 * kGratingStripe_mm)));
  };
  const PhotographQuality quality = Judge(scene);
  EXPECT_GT(quality.second_pattern_share, 0.5);
  ASSERT_FALSE(quality.warnings.empty());
  EXPECT_THAT(quality.warnings.front(), HasSubstr("second pattern"));
}

TEST(Quality, FaintStripesAreSaid) {
  testing::FringeScene scene = Wall();
  scene.ambient = 3;  // three times the flash's light, from the room
  scene.albedo = [](const Eigen::Vector3d&) { return 0.2; };
  const PhotographQuality quality = Judge(scene);
  EXPECT_LT(quality.modulation, 0.3);
  ASSERT_FALSE(quality.warnings.empty());
  EXPECT_THAT(quality.warnings.front(), HasSubstr("contrast"));
}

}  // namespace
}  // namespace striae::reconstruct
