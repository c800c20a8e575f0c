// `striae calibrate` on photographs of the virtual rig, whose parameters it does not know, and on what must be refused.
#include <cmath>
#include <fstream>

#include <gmock/gmock.h>

#include "core/calibration.h"
#include "core/optics.h"
#include "tests/app/striae_program.h"
#include "tests/support/temp_dir.h"

namespace striae {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using testing::Ran;
using testing::Striae;

constexpr int kDone = 0, kFailed = 1, kUsage = 2;

std::string ReadAll(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {(std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>()};
}

/// A grey picture without stripes (24-bit BMP).
void WriteGreyBmp(const fs::path& path, int width, int height) {
  const auto size = static_cast<std::uint32_t>(54 + 3 * width * height);
  std::string bytes = "BM";
  const auto put = [&](std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
  };
  put(size, 4), put(0, 4), put(54, 4), put(40, 4);
  put(static_cast<std::uint32_t>(width), 4), put(static_cast<std::uint32_t>(height), 4);
  put(1, 2), put(24, 2), put(0, 4), put(size - 54, 4), put(2835, 4), put(2835, 4), put(0, 4), put(0, 4);
  bytes += std::string(size - 54, '\x80');
  std::ofstream(path, std::ios::binary) << bytes;
}

class Calibrate : public ::testing::Test {
 protected:
  /// The reference plate at positions 50 mm apart.
  static void Render(const std::string& scale, const std::string& steps) {
    scene_ = new testing::TempDir;
    const Ran made = Striae(
        {"simulate", "steps", "--out", scene_->path().string(), "--scale", scale, "--steps", steps, "--step-mm", "50"});
    ASSERT_EQ(made.exit_code, kDone) << made.err;
    WriteGreyBmp(*scene_ / "grey.bmp", 2144, 1424);
  }
  static void TearDownTestSuite() {
    delete scene_;
    scene_ = nullptr;
  }

  Ran Run(const std::string& steps, const std::string& reference = "reference.ply") {
    return Striae({"calibrate", "--reference", (*scene_ / reference).string(), "--steps", (*scene_ / steps).string(),
                   "--stripes", "140", "--period-um", "48", "--distance-mm", "900", "--out", out_.string(), "--map",
                   map_.string(), "--json"});
  }
  /// Exit code 1 with that reason, nothing on stdout, no file.
  void Refused(const std::string& steps, const std::string& reason, const std::string& reference = "reference.ply") {
    const Ran ran = Run(steps, reference);
    EXPECT_EQ(ran.exit_code, kFailed) << ran.out;
    EXPECT_THAT(ran.err, HasSubstr(reason));
    EXPECT_EQ(ran.out, "");
    EXPECT_FALSE(fs::exists(out_));
    EXPECT_FALSE(fs::exists(map_));
  }
  static std::string Steps(const std::string& name, const std::vector<std::pair<std::string, double>>& lines) {
    std::ofstream csv(*scene_ / name);
    csv << "image,position_mm\n";
    for (const auto& [image, position_mm] : lines) csv << image << ',' << position_mm << '\n';
    return name;
  }

  static testing::TempDir* scene_;
  testing::TempDir results_;
  fs::path out_ = results_ / "rig.json", map_ = results_ / "differences.png";
};
testing::TempDir* Calibrate::scene_ = nullptr;

/// Needs the mesh alone.
class CalibrateFiles : public Calibrate {
 protected:
  static void SetUpTestSuite() { Render("0.05", "2"); }
};

/// Half of the D90's pixels a side: one stripe is 9 pixels; 200 mm of slide.
class CalibratePlate : public Calibrate {
 protected:
  static void SetUpTestSuite() { Render("0.5", "5"); }
};
class CalibrateLong : public CalibratePlate {};

TEST_F(CalibratePlate, FindsARigThatMeasuresWhatTheTrueOneMeasures) {
  const Ran ran = Run("steps.csv");
  ASSERT_EQ(ran.exit_code, kDone) << ran.err;
  const json report = ran.Json();
  // Half the pixels: twice the bar of 0.08 mm at full size.
  EXPECT_LT(report.at("sd_mm"), 0.16);
  EXPECT_LT(report.at("robust_sd_mm"), 0.04);
  EXPECT_GT(report.at("coverage"), 0.93);
  ASSERT_EQ(report.at("photographs").size(), 5U);
  for (const json& photograph : report.at("photographs")) {
    EXPECT_EQ(photograph.at("order_source"), "grating-edge");
    EXPECT_LT(std::abs(photograph.at("offset").get<double>()), 0.05);  // OPTICS: they settle near whole numbers
  }
  EXPECT_EQ(ReadAll(map_).substr(1, 3), "PNG");

  const auto found = CalibrationFromJson(ReadAll(out_));
  const auto truth = CalibrationFromJson(ReadAll(*scene_ / "calibration.json"));
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_TRUE(truth);
  EXPECT_EQ(found->stripes, 140);
  EXPECT_EQ(found->sources.size(), 5U);
  EXPECT_EQ(found->sources[2].position_mm, 100);
  EXPECT_EQ(found->quality->photographs, 5);
  EXPECT_NEAR(found->near_mm, 900, 35);  // the plate's relief and tilt reach that far to either side
  EXPECT_NEAR(found->far_mm, 1100, 35);
  const StripeOptics optics(*found), true_optics(*truth);
  for (const double z : {920.0, 1000.0, 1080.0}) {
    for (const double x : {300.0, 1050.0, 1800.0}) {
      const Eigen::Vector3d seen = z * RayOf(truth->camera, {x, 700});
      const auto depth = optics.DepthAt(RayOf(found->camera, {x, 700}), *true_optics.OrderAt(seen));
      ASSERT_TRUE(depth);
      EXPECT_NEAR(*depth, z, 2) << x;  // absolute distance: within 2 mm at 1 m
    }
  }
}

TEST_F(CalibrateFiles, RefusesTooFewPhotographsAndASlideThatStood) {
  Refused(Steps("two.csv", {{"step_00.jpg", 0}, {"step_04.jpg", 200}}), "fewer than three");
  Refused(Steps("stood.csv", {{"step_00.jpg", 0}, {"step_01.jpg", 0.5}, {"step_02.jpg", 1}}), "slide moved less");
}

TEST_F(CalibrateLong, RefusesPhotographsWithoutStripesOrOfAnotherSize) {
  Refused(Steps("grey.csv", {{"step_00.jpg", 0}, {"grey.bmp", 50}, {"step_02.jpg", 100}}), "grey.bmp");
  const Ran resized = Striae({"simulate", "plane", "--out", (*scene_ / "other").string(), "--scale", "0.25"});
  ASSERT_EQ(resized.exit_code, kDone) << resized.err;
  Refused(Steps("sizes.csv", {{"step_00.jpg", 0}, {"other/plane.jpg", 50}, {"step_02.jpg", 100}}), "pixels");
}

TEST_F(CalibrateLong, RefusesTheWrongMesh) {
  const Ran other = Striae({"simulate", "steps", "--out", (*scene_ / "large").string(), "--range", "large", "--scale",
                            "0.05", "--steps", "2"});
  ASSERT_EQ(other.exit_code, kDone) << other.err;
  Refused("steps.csv", "these photographs cannot calibrate the rig", "large/reference.ply");
}

TEST_F(CalibrateLong, RefusesAWrongPosition) {
  // The third photograph was taken at 100 mm.
  Refused(
      Steps(
          "slip.csv",
          {{"step_00.jpg", 0}, {"step_01.jpg", 50}, {"step_02.jpg", 110}, {"step_03.jpg", 150}, {"step_04.jpg", 200}}),
      "position");
}

TEST_F(CalibrateFiles, SaysWhatIsWrongWithItsFiles) {
  Refused("nowhere.csv", "nowhere.csv");
  Refused(Steps("absent.csv", {{"absent.jpg", 0}, {"step_01.jpg", 50}, {"step_02.jpg", 100}}), "absent.jpg");
  std::ofstream(*scene_ / "torn.ply") << "ply\nformat";
  Refused("steps.csv", "torn.ply", "torn.ply");
  EXPECT_EQ(Striae({"calibrate", "--stripes", "140"}).exit_code, kUsage);
}

}  // namespace
}  // namespace striae
