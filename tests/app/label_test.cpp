// A label of known size on a body that shows no end of the grating, and photographs in which something is wrong,
// through the program: what it says, and how far off its surface is from the truth of the virtual rig.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>

#include "core/ply.h"
#include "tests/app/striae_program.h"
#include "tests/support/files.h"
#include "tests/support/temp_dir.h"

namespace striae {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::Ran;
using testing::Striae;
using testing::TempDir;

/// Half the D90's pixels a side: the label's cells still have nine of them.
std::vector<std::string> Simulated(const fs::path& folder, const std::string& body, std::vector<std::string> more) {
  std::vector<std::string> words = {"simulate", body, "--scale", "0.5", "--out", folder.string()};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

class LabelledBall : public ::testing::Test {
 protected:
  void SetUp() override {
    const Ran ran = Striae(Simulated(folder_.path(), "ball", {"--label", "7,30,0,0"}));
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
  }
  Ran Reconstruct(const std::vector<std::string>& more) {
    std::vector<std::string> words = {"reconstruct", At("ball.jpg"), "--calibration", At("calibration.json"),
                                      "--out",       At("ball.ply"), "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return Striae(words);
  }
  /// Median over the points of how far they lie outside of the ball that was rendered, mm.
  double MedianOutside() {
    const auto truth = nlohmann::json::parse(testing::ReadText(At("truth.json"))).at("photographs").at(0);
    const auto center = truth.at("center_mm").get<std::vector<float>>();
    const Eigen::Vector3f middle(center[0], center[1], center[2]);
    const auto surface = DecodePly(testing::ReadBytes(At("ball.ply")));
    std::vector<double> outside;
    for (const auto& point : surface.value().point_in_camera) {
      outside.push_back(static_cast<double>((point - middle).norm()) - truth.at("radius_mm").get<double>());
    }
    const auto half = outside.begin() + static_cast<long>(outside.size() / 2);
    std::nth_element(outside.begin(), half, outside.end());
    return *half;
  }
  std::string At(const std::string& name) { return (folder_.path() / name).string(); }
  TempDir folder_;
};

TEST_F(LabelledBall, TheLabelGivesTheWholeStripe) {
  const Ran ran = Reconstruct({"--label-mm", "30"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto document = ran.Json();
  EXPECT_EQ(document.at("label").at("marker_id"), 7);
  EXPECT_EQ(document.at("regions").at(0).at("order_source"), "target");
  // A stripe is 16 mm deep here; without one to spare the surface is right to a fraction of a millimetre.
  EXPECT_LT(std::abs(MedianOutside()), 0.2);
}

TEST_F(LabelledBall, WithoutItTheDistanceDecidesAndIsDoubted) {
  const Ran ran = Reconstruct({});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto region = ran.Json().at("regions").at(0);
  EXPECT_EQ(region.at("order_source"), "distance");
  EXPECT_LT(region.at("order_margin"), 0.4);
  EXPECT_THAT(region.at("warning"), HasSubstr("let the grating's edge or a label fall on the subject"));
}

TEST_F(LabelledBall, ALabelThatIsNotThereIsSaid) {
  const Ran ran = Striae(Simulated(folder_.path(), "ball", {}));
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_THAT(Reconstruct({"--label-mm", "30"}).err, HasSubstr("the label is not found"));
}

/// A limb photographed with these options of the virtual rig, reconstructed.
Ran ReconstructedLimb(const TempDir& folder, const std::vector<std::string>& how) {
  Ran ran = Striae(Simulated(folder.path(), "limb", how));
  if (ran.exit_code != 0) throw std::runtime_error(ran.err);
  return Striae({"reconstruct", (folder / "limb.jpg").string(), "--calibration", (folder / "calibration.json").string(),
                 "--out", (folder / "s.ply").string()});
}

TEST(Blurred, FarOutOfFocusIsRefused) {
  const TempDir folder;
  const Ran ran = ReconstructedLimb(folder, {"--focus-mm", "600"});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("in focus"));
  EXPECT_FALSE(fs::exists(folder / "s.ply"));
}

TEST(Blurred, OutOfFocusIsDoubted) {
  const TempDir folder;
  EXPECT_THAT(ReconstructedLimb(folder, {"--focus-mm", "1500"}).err,
              HasSubstr("the photograph is out of focus or blurred by motion"));
}

TEST(Overexposed, IsSaid) {
  const TempDir folder;  // fifteen times the light: the crests are white
  EXPECT_THAT(ReconstructedLimb(folder, {"--flash", "20"}).err,
              HasSubstr("is saturated and carries no phase; lower the ISO"));
}

}  // namespace
}  // namespace striae
