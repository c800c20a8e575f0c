// measure head through the program: two files, drawn regions, a series, pictures, and what it refuses.
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "analysis/head/angles.h"
#include "core/ply.h"
#include "tests/app/striae_program.h"
#include "tests/head/bust.h"
#include "tests/support/files.h"
#include "tests/support/temp_dir.h"

namespace striae {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Bust;
using ::testing::HasSubstr;
using testing::Ran;
using testing::ReadBytes;
using testing::Striae;
using testing::TempDir;
using testing::WriteBytes;

constexpr int kDone = 0, kFailed = 1, kUsage = 2;
constexpr double kNoiseMm = 0.3;
const std::string kPhotograph(64, 'a');

/// Surfaces of one procedural person, written once: neutral, and rotations of 20, 20 again, and -15 deg.
class Captures {
 public:
  static const Captures& Get() {
    static const Captures captures;
    return captures;
  }
  [[nodiscard]] std::string File(const std::string& name) const { return (folder_ / (name + ".ply")).string(); }
  static constexpr double kLeft = 20, kRight = -15;

 private:
  Captures() {
    Write("neutral", 0, 1);
    Write("left", kLeft, 2);
    Write("left_again", kLeft, 3);
    Write("right", kRight, 4);
    Write("right_again", kRight, 5);
    Keep("sphere", testing::SphereSeenFromTheFront(180, kNoiseMm, 1));
  }
  void Write(const std::string& name, double rotation_deg, std::uint32_t seed) {
    Bust bust;
    bust.head_rotation = head::Compose({Angle::Degrees(rotation_deg), Angle::Degrees(4), Angle::Degrees(0), {}});
    Keep(name, SeenFromTheFront(bust, kNoiseMm, seed));
  }
  void Keep(const std::string& name, Surface surface) {
    surface.colour.resize(surface.size());
    surface.quality.resize(surface.size());
    surface.comments = {"photograph sha256 " + kPhotograph};
    WriteBytes(folder_ / (name + ".ply"), EncodePly(surface));
  }
  TempDir folder_;
};

std::string File(const std::string& name) { return Captures::Get().File(name); }

double Value(const json& report, const std::string& name) {
  for (const json& m : report["measurements"]) {
    if (m["name"] == name) return m["value"].get<double>();
  }
  return std::nan("");
}

TEST(MeasureHeadCommand, TwoFilesGiveOneReportWithWordsAndBands) {
  const Ran ran = Striae({"measure", "head", File("neutral"), File("left"), "--json"});
  ASSERT_EQ(ran.exit_code, kDone) << ran.err;
  const json report = ran.Json();
  EXPECT_EQ(report["analysis"], "head");
  EXPECT_NEAR(Value(report, "rotation"), Captures::kLeft, 0.4);  // as the library's own test at more noise
  EXPECT_EQ(report["inputs"].size(), 2U);
  const Ran text = Striae({"measure", "head", File("neutral"), File("left")});
  EXPECT_THAT(text.out, HasSubstr("to the subject's left"));
  EXPECT_THAT(text.out, HasSubstr("TWSTRS 1: slight"));
}

TEST(MeasureHeadCommand, ASeriesGivesTheRangeOfMotionAndTheRepeatability) {
  const Ran ran = Striae({"measure", "head", File("neutral"), File("left"), File("left_again"), File("right"),
                          File("right_again"), "--repeats", "2", "--json"});
  ASSERT_EQ(ran.exit_code, kDone) << ran.err;
  const json series = ran.Json();
  EXPECT_EQ(series["analysis"], "head-series");
  ASSERT_EQ(series["poses"].size(), 4U);
  EXPECT_EQ(series["poses"][3]["repeat_of"], 2);
  const json& range = series["range_of_motion"][0];
  EXPECT_EQ(range["name"], "rotation");
  EXPECT_NEAR(range["value"].get<double>(), Captures::kLeft - Captures::kRight, 0.8);  // 0.4 at either end
  const json& spread = series["repeatability"][0];
  EXPECT_EQ(spread["degrees_of_freedom"], 2);
  EXPECT_LT(spread["sem"].get<double>(), 0.4);  // the bar for photographs
  EXPECT_NEAR(spread["mdc95"].get<double>(), 2.772 * spread["sem"].get<double>(), 1e-3);
}

TEST(MeasureHeadCommand, ARefusedPoseStandsInTheSeriesWithItsReason) {
  const Ran ran = Striae({"measure", "head", File("neutral"), File("left"), File("sphere"), "--json"});
  ASSERT_EQ(ran.exit_code, kDone) << ran.err;
  const json series = ran.Json();
  EXPECT_THAT(series["poses"][1]["refused"].get<std::string>(), HasSubstr("torso"));
  EXPECT_FALSE(series["poses"][1].contains("measurements"));
  EXPECT_NEAR(series["range_of_motion"][0]["value"].get<double>(), Captures::kLeft, 0.4);
  EXPECT_TRUE(series["repeatability"].empty());
  EXPECT_EQ(Striae({"measure", "head", File("neutral"), File("sphere"), File("sphere")}).exit_code, kFailed);
}

TEST(MeasureHeadCommand, OneCaptureGivesAbsoluteAnglesThatSayTheyAreLessCertain) {
  const Ran ran = Striae({"measure", "head", File("left"), "--absolute", "--json"});
  ASSERT_EQ(ran.exit_code, kDone) << ran.err;
  const json report = ran.Json();
  EXPECT_EQ(report["axes_source"], "anatomical");
  EXPECT_NEAR(Value(report, "rotation"), Captures::kLeft, 3);  // one standard uncertainty of people's shape
  EXPECT_GE(report["measurements"][0]["uncertainty"].get<double>(), 3);
  EXPECT_EQ(Striae({"measure", "head", File("neutral")}).exit_code, kUsage);
  EXPECT_EQ(Striae({"measure", "head", File("neutral"), File("left"), "--absolute"}).exit_code, kUsage);
}

TEST(MeasureHeadCommand, RepeatsMustDivideThePoses) {
  const Ran ran = Striae({"measure", "head", File("neutral"), File("left"), File("right"), "--repeats", "3"});
  EXPECT_EQ(ran.exit_code, kUsage);
  EXPECT_THAT(ran.err, HasSubstr("--repeats 3"));
}

TEST(MeasureHeadCommand, DrawnRegionsAreUsedAndKept) {
  const TempDir folder;
  json drawn = {{"head_px", {{190, 35}, {250, 35}, {250, 95}, {190, 95}}}, {"image_sha256", kPhotograph}};
  const auto write = [&] {
    const std::string text = drawn.dump();
    WriteBytes(folder / "regions.json", {text.begin(), text.end()});
    return (folder / "regions.json").string();
  };
  const Ran ran = Striae({"measure", "head", File("neutral"), File("left"), "--regions", write(), "--json"});
  ASSERT_EQ(ran.exit_code, kDone) << ran.err;
  const json report = ran.Json();
  EXPECT_NEAR(Value(report, "rotation"), Captures::kLeft, 0.4);
  EXPECT_EQ(report["regions"]["head_source"], "drawn");
  EXPECT_EQ(report["regions"]["head_px"], drawn["head_px"]);
  EXPECT_EQ(report["regions"]["torso_source"], "found");
  ASSERT_EQ(report["inputs"].size(), 3U);
  EXPECT_EQ(report["inputs"][2]["name"], "regions");

  drawn["image_sha256"] = std::string(64, 'b');
  const Ran other = Striae({"measure", "head", File("neutral"), File("left"), "--regions", write()});
  EXPECT_EQ(other.exit_code, kFailed);
  EXPECT_THAT(other.err, HasSubstr("another photograph"));
}

TEST(MeasureHeadCommand, PicturesAreWrittenAndAreTheSameEveryTime) {
  const TempDir folder;
  const char* names[] = {"before.png", "after.png", "residuals.png", "angles.png"};
  for (const char* run : {"one", "two"}) {
    const Ran ran =
        Striae({"measure", "head", File("neutral"), File("left"), "--pictures", (folder / run).string(), "--json"});
    ASSERT_EQ(ran.exit_code, kDone) << ran.err;
    EXPECT_EQ(ran.Json()["pictures"].size(), 4U);
  }
  for (const char* name : names) {
    const auto one = ReadBytes(folder / "one" / name);
    EXPECT_GT(one.size(), 5000U) << name;  // an empty sheet of this size packs into less
    EXPECT_EQ(one, ReadBytes(folder / "two" / name)) << name;
  }
  EXPECT_NE(ReadBytes(folder / "one/before.png"), ReadBytes(folder / "one/after.png"));
}

TEST(MeasureHeadCommand, ARefusalLeavesNoPictures) {
  const TempDir folder;
  const Ran ran =
      Striae({"measure", "head", File("neutral"), File("sphere"), "--pictures", (folder / "none").string(), "--json"});
  EXPECT_EQ(ran.exit_code, kFailed);
  EXPECT_FALSE(fs::exists(folder / "none"));
}

}  // namespace
}  // namespace striae
