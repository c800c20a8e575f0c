// The check of the rig through the program: from photographs of the virtual rig and from surfaces, stateless and in a
// study, until its failure flags what the device measured.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include "core/ply.h"
#include "tests/app/striae_program.h"
#include "tests/reconstruct/artefacts.h"
#include "tests/support/files.h"
#include "tests/support/temp_dir.h"

namespace striae {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using testing::Ran;
using testing::ReadText;
using testing::Striae;
using testing::TempDir;

constexpr int kDone = 0, kFailed = 1, kUsage = 2;
constexpr const char* kSerial = "3990001";  // what the virtual rig writes into EXIF

/// Quarter-size photographs of a plate and of a limb with its wound, made once.
class Scene {
 public:
  static const Scene& Get() {
    static const Scene scene;
    return scene;
  }
  [[nodiscard]] std::string plane() const { return (folder_ / "plane/plane.jpg").string(); }
  [[nodiscard]] std::string calibration() const { return (folder_ / "plane/calibration.json").string(); }
  [[nodiscard]] std::string limb() const { return (folder_ / "limb/limb.jpg").string(); }
  [[nodiscard]] std::string outline() const { return (folder_ / "limb/limb.outline.json").string(); }

 private:
  Scene() {
    for (const char* shape : {"plane", "limb"}) {
      const Ran ran = Striae({"simulate", shape, "--scale", "0.25", "--out", (folder_ / shape).string()});
      if (ran.exit_code != 0) throw std::runtime_error(ran.err);
    }
  }
  TempDir folder_;
};

std::string WritePly(const fs::path& file, Surface surface, const std::vector<std::string>& comments = {}) {
  surface.comments = comments;
  testing::WriteBytes(file, EncodePly(surface));
  return file.string();
}

Surface BentPlate(double flatness_mm) {
  return testing::Seen(
      {testing::Plate({0, 0, 1000}, 100, 0.1, [=](double u, double v) { return flatness_mm / 2 * (u * u - v * v); })});
}

TEST(VerifyPlane, MeasuresThePlateOfAPhotograph) {
  const Ran ran =
      Striae({"verify", "plane", Scene::Get().plane(), "--calibration", Scene::Get().calibration(), "--json"});
  ASSERT_EQ(ran.exit_code, kDone) << ran.err;
  const json document = ran.Json();
  EXPECT_EQ(document.at("check"), "plane");
  EXPECT_EQ(document.at("passed"), true);
  EXPECT_EQ(document.at("range"), "small");
  const json& input = document.at("inputs").at(0);
  // The bar of the 1 m range: 0.10 mm over all points.
  EXPECT_LT(input.at("sd_mm").get<double>(), 0.10);
  EXPECT_GT(input.at("sd_mm").get<double>(), 0.001) << "a photograph has noise";
  EXPECT_EQ(input.at("sha256").get<std::string>().size(), 64U);
  EXPECT_EQ(input.at("calibration_sha256").get<std::string>().size(), 64U);
}

TEST(VerifyPlane, FailsBeyondItsTolerance) {
  const TempDir dir;
  const std::string bent = WritePly(dir / "bent.ply", BentPlate(2));
  const Ran failed = Striae({"verify", "plane", bent, "--json"});
  EXPECT_EQ(failed.exit_code, kFailed);
  EXPECT_EQ(failed.Json().at("passed"), false) << "the figures are printed all the same";
  EXPECT_THAT(failed.err, HasSubstr("out of tolerance"));
  EXPECT_NEAR(failed.Json().at("worst_mm").at("flatness").get<double>(), 2, 0.2);
  EXPECT_EQ(Striae({"verify", "plane", bent, "--tolerance-mm", "2.5"}).exit_code, kDone);
  EXPECT_EQ(Striae({"verify", "plane", bent, "--range", "large"}).exit_code, kDone);
  const std::string flat = WritePly(dir / "flat.ply", BentPlate(0));
  const Ran both = Striae({"verify", "plane", flat, bent, "--json"});
  EXPECT_EQ(both.exit_code, kFailed) << "the worst of several counts";
  EXPECT_EQ(both.Json().at("inputs").at(0).at("passed"), true);
  EXPECT_EQ(both.Json().at("inputs").at(1).at("passed"), false);
}

TEST(VerifyBall, MeasuresFormSizeAndDistance) {
  const TempDir dir;
  const Eigen::Vector3d left(-70, 0, 1000), right(80, 0, 1000);
  const std::string bar =
      WritePly(dir / "bar.ply", testing::Seen({testing::Ball(left, 30.1), testing::Ball(right, 30.1)}));
  const Ran distance = Striae({"verify", "distance", bar, "--diameter-mm", "60", "--distance-mm", "150.4", "--json"});
  ASSERT_EQ(distance.exit_code, kDone) << distance.err;
  EXPECT_NEAR(distance.Json().at("worst_mm").at("spacing").get<double>(), -0.4, 0.002);
  const std::string one = WritePly(dir / "ball.ply", testing::Seen({testing::Ball(left, 30.1)}));
  const Ran ball = Striae({"verify", "ball", one, "--diameter-mm", "60", "--json"});
  ASSERT_EQ(ball.exit_code, kDone) << ball.err;
  EXPECT_NEAR(ball.Json().at("worst_mm").at("size").get<double>(), 0.2, 0.002);
  EXPECT_LT(ball.Json().at("worst_mm").at("form").get<double>(), 0.002);
  EXPECT_EQ(Striae({"verify", "ball", one, "--diameter-mm", "60", "--tolerance-mm", "0.1"}).exit_code, kFailed);
}

TEST(Verify, SaysWhatIsWrongWithItsInput) {
  const TempDir dir;
  const auto refused = [](const std::vector<std::string>& words, int code, const char* message) {
    const Ran ran = Striae(words);
    EXPECT_EQ(ran.exit_code, code) << ran.err;
    EXPECT_EQ(ran.out, "");
    EXPECT_THAT(ran.err, HasSubstr(message));
  };
  const std::string limb = WritePly(dir / "limb.ply", testing::Seen({testing::Limb({0, 0, 1060}, 60)}));
  refused({"verify", "plane", limb}, kFailed, "bends away");
  refused({"verify", "ball", limb, "--diameter-mm", "120"}, kFailed, "no ball of 120 mm");
  refused({"verify", "ball", limb}, kUsage, "--diameter-mm");
  refused({"verify", "plane", Scene::Get().plane()}, kUsage, "--calibration");
  refused({"verify", "plane", (dir / "none.ply").string()}, kFailed, "does not exist");
  refused({"verify", "plane", limb, "--date", "2026-05-04"}, kUsage, "--device");
  refused({"verify", "plane", limb, "--tolerance-mm", "-1"}, kUsage, "--tolerance-mm");
  std::ofstream(dir / "cut.ply") << "ply\nformat binary_little_endian 1.0\n";
  refused({"verify", "plane", (dir / "cut.ply").string()}, kFailed, "cut.ply");
}

/// A study whose device took and measured a wound.
class CheckedStudy : public ::testing::Test {
 protected:
  CheckedStudy() {
    Done({"init", study_, "--protocol", "WND-01", "--title", "Healing", "--sponsor", "Example Institute", "--site",
          "LJ"});
    In({"subject", "add", "S001"});
    In({"consent", "S001", "--given", "2026-01-02"});
    In({"device", "add", "--serial", kSerial, "--range", "small"});
    In({"calibration", "add", Scene::Get().calibration(), "--device", kSerial, "--valid-from", "2026-01-01"});
    session_ = In({"session", "open", "--subject", "S001", "--visit", "V1"}).at("id");
    In({"import", "--session", session_, Scene::Get().limb(), "--as", "wound:W1"});
    const std::string capture = In({"show", session_}).at("captures").at(0).at("id");
    In({"outline", capture, Scene::Get().outline()});
    In({"process"});
  }

  static json Done(std::vector<std::string> words, int code = kDone) {
    words.emplace_back("--json");
    const Ran ran = Striae(words);
    EXPECT_EQ(ran.exit_code, code) << words[2] << ": " << ran.err;
    return ran.Json();
  }
  [[nodiscard]] std::vector<std::string> InStudy(std::vector<std::string> words) const {
    words.insert(words.begin(), {"-C", study_});
    return words;
  }
  json In(const std::vector<std::string>& words, int code = kDone) const { return Done(InStudy(words), code); }
  void Refused(const std::vector<std::string>& words, const char* message) const {
    const Ran ran = Striae(InStudy(words));
    EXPECT_EQ(ran.exit_code, kFailed);
    EXPECT_THAT(ran.err, HasSubstr(message));
    EXPECT_EQ(In({"verify", "history", "--device", kSerial}).at("checks"), json::array()) << "nothing was recorded";
  }
  /// Status of the volume in force.
  [[nodiscard]] json Volume() const {
    const json results = In({"results"});
    for (const json& m : results.at("measurements")) {
      if (m.at("name") == "volume") return m;
    }
    return {};
  }

  TempDir dir_;
  std::string study_ = (dir_ / "trial").string();
  std::string session_;
};

TEST_F(CheckedStudy, AFailedCheckFlagsWhatTheDeviceMeasuredUntilOneIsPassed) {
  ASSERT_EQ(Volume().at("status"), "ok") << Volume().dump();
  const json passed = In({"verify", "plane", Scene::Get().plane(), "--device", kSerial, "--date", "2026-01-05"});
  EXPECT_EQ(passed.at("passed"), true);
  In({"process"});
  EXPECT_EQ(Volume().at("status"), "ok");

  // The photograph measures flat to a few tenths of a millimetre; a tolerance below that fails.
  const json failed =
      In({"verify", "plane", Scene::Get().plane(), "--device", kSerial, "--tolerance-mm", "0.001"}, kFailed);
  const std::string id = failed.at("id");
  const json status = In({"status"});
  EXPECT_EQ(status.at("devices_out_of_tolerance").at(0).at("id"), id);
  EXPECT_THAT(Striae(InStudy({"status"})).out, HasSubstr("DEVICE 3990001 (small) failed its plane check"));
  In({"process"});
  const json flagged = Volume();
  EXPECT_EQ(flagged.at("status"), "flagged");
  EXPECT_THAT(flagged.at("reason").get<std::string>(), HasSubstr(id.substr(0, 8)));
  EXPECT_THAT(flagged.at("reason").get<std::string>(), HasSubstr("2026-01-05"));
  const fs::path report = dir_ / "S001.html";
  ASSERT_EQ(Striae(InStudy({"report", "S001", "--out", report.string()})).exit_code, kDone);
  EXPECT_THAT(ReadText(report), HasSubstr("(plane, " + id.substr(0, 8) + ")"));

  // Passed again: the failure stays in the record, and so does the doubt about what was measured before it.
  In({"verify", "plane", Scene::Get().plane(), "--device", kSerial});
  EXPECT_EQ(In({"status"}).at("devices_out_of_tolerance"), json::array());
  In({"process"});
  EXPECT_EQ(Volume().at("status"), "flagged");

  EXPECT_EQ(In({"verify", "history", "--device", kSerial}).at("checks").size(), 3U);
  EXPECT_EQ(In({"history", id}).at("history").size(), 1U);
  EXPECT_EQ(In({"check"}).at("passed"), true);
}

TEST_F(CheckedStudy, ACheckThatPassedBetweenTheFailureAndTheSessionLiftsTheDoubt) {
  In({"verify", "plane", Scene::Get().plane(), "--device", kSerial, "--date", "2026-01-05", "--tolerance-mm", "0.001"},
     kFailed);
  In({"process"});
  EXPECT_EQ(Volume().at("status"), "flagged");
  In({"verify", "plane", Scene::Get().plane(), "--device", kSerial, "--date", "2026-01-06"});
  In({"process"});
  EXPECT_EQ(Volume().at("status"), "ok") << "recorded late, it still says that the device was right on that day";
}

TEST_F(CheckedStudy, TheHistoryIsPlotted) {
  for (const char* date : {"2026-01-05", "2026-02-05", "2026-03-05"}) {
    In({"verify", "plane", Scene::Get().plane(), "--device", kSerial, "--date", date});
  }
  for (const char* name : {"drift.svg", "drift.png", "drift.pdf"}) {
    const std::string first = (dir_ / name).string(), second = (dir_ / (std::string("again-") + name)).string();
    In({"verify", "history", "--device", kSerial, "--plot", first});
    In({"verify", "history", "--device", kSerial, "--plot", second});
    EXPECT_GT(fs::file_size(first), 1000U);
    EXPECT_EQ(ReadText(first), ReadText(second)) << name;
  }
  const std::string svg = ReadText(dir_ / "drift.svg");
  EXPECT_THAT(svg, HasSubstr("Flatness of a plane (mm)"));
  EXPECT_THAT(svg, HasSubstr("2026-0"));
  EXPECT_THAT(svg, ::testing::Not(HasSubstr("Form of a ball"))) << "nothing of what was not checked";
  EXPECT_EQ(Striae(InStudy({"verify", "history", "--device", kSerial, "--plot", "drift.txt"})).exit_code, kUsage);
}

TEST_F(CheckedStudy, ChecksThatProveNothingAboutTheDeviceAreRefused) {
  In({"device", "add", "--serial", "777", "--range", "small"});
  In({"calibration", "add", Scene::Get().calibration(), "--device", "777", "--valid-from", "2026-01-01"});
  Refused({"verify", "plane", Scene::Get().plane(), "--device", "777"}, "was taken with body 3990001");
  Refused({"verify", "plane", Scene::Get().plane(), "--device", "404"}, "no device '404'");
  Refused({"verify", "plane", WritePly(dir_ / "flat.ply", BentPlate(0)), "--device", kSerial},
          "does not say which calibration");
  const std::string other = "calibration sha256 " + std::string(64, 'a');
  Refused({"verify", "plane", WritePly(dir_ / "other.ply", BentPlate(0), {other}), "--device", kSerial},
          "none of device");
  Refused({"verify", "plane", WritePly(dir_ / "limb.ply", testing::Seen({testing::Limb({0, 0, 1060}, 60)})), "--device",
           kSerial},
          "");
}

TEST_F(CheckedStudy, LabelsAreFoundBySessionAndCode) {
  const std::string out = (dir_ / "label.pdf").string();
  const json by_id = In({"print", "label", "--session", session_, "--out", out});
  const std::string code = by_id.at("labels").at(0).at("code");
  EXPECT_EQ(by_id.at("labels").at(0).at("side_mm"), 40);
  EXPECT_GT(fs::file_size(out), 1000U);
  const json by_code = In({"print", "label", "--session", code, "--out", out, "--side-mm", "60", "--copies", "3"});
  EXPECT_EQ(by_code.at("labels").at(0).at("session"), session_);
  EXPECT_EQ(by_code.at("labels").at(0).at("marker"), by_id.at("labels").at(0).at("marker"));
  const fs::path none = dir_ / "none.pdf";
  const Ran unknown = Striae(InStudy({"print", "label", "--session", "0000-0000", "--out", none.string()}));
  EXPECT_EQ(unknown.exit_code, kFailed);
  EXPECT_THAT(unknown.err, HasSubstr("session list"));
  EXPECT_EQ(
      Striae(InStudy({"print", "label", "--session", session_, "--out", none.string(), "--side-mm", "300"})).exit_code,
      kUsage);
  EXPECT_FALSE(fs::exists(none));
}

TEST(PrintBoard, NeedsNoStudy) {
  const TempDir dir;
  const Ran ran = Striae({"print", "board", "--range", "large", "--out", (dir / "board.pdf").string(), "--json"});
  ASSERT_EQ(ran.exit_code, kDone) << ran.err;
  EXPECT_EQ(ran.Json().at("paper"), "A3");
  EXPECT_EQ(ReadText(dir / "board.pdf").substr(0, 5), "%PDF-");
  EXPECT_EQ(Striae({"print", "board", "--range", "tiny", "--out", (dir / "x.pdf").string()}).exit_code, kUsage);
}

}  // namespace
}  // namespace striae
