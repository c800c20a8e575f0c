// Every kind of bad input, through the program: a clear error that says what to do, the right exit code, and nothing
// half-written.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/app/striae_program.h"
#include "tests/support/files.h"
#include "tests/support/temp_dir.h"

namespace striae {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::Ran;
using testing::ReadText;
using testing::Striae;
using testing::TempDir;

/// A half-size scene of the virtual rig, its surface and everything to measure it, made once for all tests.
class Scene {
 public:
  static const Scene& Get() {
    static const Scene scene;
    return scene;
  }
  [[nodiscard]] fs::path photograph() const { return folder_ / "limb/limb.jpg"; }
  [[nodiscard]] fs::path calibration() const { return folder_ / "limb/calibration.json"; }
  [[nodiscard]] fs::path outline() const { return folder_ / "limb/limb.outline.json"; }
  [[nodiscard]] fs::path surface() const { return folder_ / "limb.ply"; }

 private:
  Scene() {
    const Ran simulated = Striae({"simulate", "limb", "--scale", "0.5", "--out", (folder_ / "limb").string()});
    if (simulated.exit_code != 0) throw std::runtime_error(simulated.err);
    const Ran ran = Striae(
        {"reconstruct", photograph().string(), "--calibration", calibration().string(), "--out", surface().string()});
    if (ran.exit_code != 0) throw std::runtime_error(ran.err);
  }
  TempDir folder_;
};

void Write(const fs::path& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

std::size_t FilesIn(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::recursive_directory_iterator(folder), {}));
}

/// Runs `reconstruct` and expects a refusal that leaves the output folder empty.
void ExpectRefused(const fs::path& image, const fs::path& calibration, const std::string& words) {
  const TempDir out;
  const Ran ran = Striae(
      {"reconstruct", image.string(), "--calibration", calibration.string(), "--out", (out / "surface.ply").string()});
  EXPECT_EQ(ran.exit_code, 1) << ran.err;
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(ran.err, HasSubstr(words));
  EXPECT_EQ(FilesIn(out.path()), 0U);
}

TEST(BadPhotograph, TruncatedAnywhere) {
  const TempDir folder;
  const std::string whole = ReadText(Scene::Get().photograph());
  for (const double share : {0.0, 0.001, 0.3, 0.999}) {
    Write(folder / "cut.jpg", whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
    ExpectRefused(folder / "cut.jpg", Scene::Get().calibration(), "take the file from the camera's card again");
  }
}

TEST(BadPhotograph, WithoutStripes) {
  const TempDir folder;
  const cv::Mat photograph = cv::imread(Scene::Get().photograph().string(), cv::IMREAD_IGNORE_ORIENTATION);
  cv::Mat grey(photograph.size(), CV_8UC1, cv::Scalar(90));
  cv::imwrite((folder / "grey.png").string(), grey);
  ExpectRefused(folder / "grey.png", Scene::Get().calibration(), "check that the flash fired");
  cv::imwrite((folder / "white.png").string(), cv::Mat(photograph.size(), CV_8UC1, cv::Scalar(255)));
  ExpectRefused(folder / "white.png", Scene::Get().calibration(), "check that the flash fired");
}

TEST(BadPhotograph, OfAnotherSizeThanTheCalibrations) {
  const TempDir folder;
  const cv::Mat photograph = cv::imread(Scene::Get().photograph().string(), cv::IMREAD_IGNORE_ORIENTATION);
  cv::imwrite((folder / "cropped.png").string(), photograph(cv::Rect(0, 0, photograph.cols - 16, photograph.rows)));
  ExpectRefused(folder / "cropped.png", Scene::Get().calibration(), "use the full-size original");
  cv::imwrite((folder / "dot.png").string(), photograph(cv::Rect(0, 0, 1, 1)));
  ExpectRefused(folder / "dot.png", Scene::Get().calibration(), "use the full-size original");
}

TEST(BadPhotograph, Missing) {
  ExpectRefused("no-such-photograph.jpg", Scene::Get().calibration(), "no-such-photograph.jpg does not exist");
  ExpectRefused(Scene::Get().photograph(), "no-such-calibration.json", "no-such-calibration.json does not exist");
}

TEST(BadPhotograph, EmptyFolderOrOfTwoHundredMegapixels) {
  const TempDir folder;
  Write(folder / "empty.jpg", "");
  ExpectRefused(folder / "empty.jpg", Scene::Get().calibration(), "the file is empty");
  fs::create_directory(folder / "folder.jpg");
  ExpectRefused(folder / "folder.jpg", Scene::Get().calibration(), "is a folder, not a file");
  cv::imwrite((folder / "huge.png").string(), cv::Mat(16, 16, CV_8UC1, cv::Scalar(9)));
  std::string huge = ReadText(folder / "huge.png");
  for (const std::size_t at : {std::size_t{18}, std::size_t{22}}) {  // 14142 x 14142
    huge[at] = static_cast<char>(14142 >> 8);
    huge[at + 1] = static_cast<char>(14142 & 0xff);
  }
  Write(folder / "huge.png", huge);
  ExpectRefused(folder / "huge.png", Scene::Get().calibration(), "more than 100 megapixels");
}

TEST(BadPhotograph, ItsContentCountsAndNotItsName) {
  const TempDir folder, out;
  fs::copy_file(Scene::Get().photograph(), folder / "limb.png");
  const Ran ran = Striae({"phase", (folder / "limb.png").string(), "--out", (out / "phase.tiff").string()});
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
}

TEST(BadPhotograph, PhaseRefusesItToo) {
  const TempDir folder, out;
  Write(folder / "text.jpg", "this is no photograph");
  const Ran ran = Striae({"phase", (folder / "text.jpg").string(), "--out", (out / "phase.tiff").string()});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("[bad-image]"));
  EXPECT_EQ(FilesIn(out.path()), 0U);
}

TEST(BadCalibration, NamesTheField) {
  const TempDir folder;
  for (const char* text : {"", "{}", "{\"format\":\"striae-calibration/1\"}"}) {
    Write(folder / "cal.json", text);
    ExpectRefused(Scene::Get().photograph(), folder / "cal.json", "[bad-calibration]");
  }
  auto rig = nlohmann::json::parse(ReadText(Scene::Get().calibration()));
  rig["camera"]["fx"] = std::nan("");  // JSON has no NaN: it is written as null
  Write(folder / "cal.json", rig.dump());
  ExpectRefused(Scene::Get().photograph(), folder / "cal.json", "/camera/fx");
  rig["camera"]["fx"] = -5;
  Write(folder / "cal.json", rig.dump());
  ExpectRefused(Scene::Get().photograph(), folder / "cal.json", "/camera/fx must be positive");
}

TEST(BadOutput, AFullDiskLeavesNothing) {
  const TempDir folder;
  // A limit on the size of files stands in for a full disk: the surface has megabytes, the limit is 512 KiB.
  const Ran ran = testing::RunProgram(
      "/bin/sh", {"-c", "ulimit -f 1024; exec \"$0\" reconstruct \"$1\" --calibration \"$2\" --out \"$3\"",
                  (fs::path(STRIAE_BINARY_DIR) / "striae").string(), Scene::Get().photograph().string(),
                  Scene::Get().calibration().string(), (folder / "surface.ply").string()});
  EXPECT_EQ(ran.exit_code, 1) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("free space"));
  EXPECT_EQ(FilesIn(folder.path()), 0U);
}

TEST(BadOutput, AFolderInItsPlaceIsSaidBeforeAnythingIsComputed) {
  const TempDir folder;
  fs::create_directory(folder / "surface.ply");
  const Ran ran = Striae({"reconstruct", "no-such-photograph.jpg", "--calibration", "no-such-calibration.json", "--out",
                          (folder / "surface.ply").string()});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("give the name of a file"));
}

TEST(BadOutput, AFolderThatIsNotThereLeavesNothing) {
  const TempDir folder;
  const Ran ran = Striae({"reconstruct", Scene::Get().photograph().string(), "--calibration",
                          Scene::Get().calibration().string(), "--out", (folder / "none/surface.ply").string()});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("check the folder"));
  EXPECT_EQ(FilesIn(folder.path()), 0U);
}

Ran MeasureWound(const nlohmann::json& outline) {
  const TempDir folder;
  Write(folder / "outline.json", outline.dump());
  return Striae(
      {"measure", "wound", Scene::Get().surface().string(), "--outline", (folder / "outline.json").string(), "--json"});
}

TEST(BadOutline, OffTheSurface) {
  const Ran ran = MeasureWound({{"polygon_px", {{5, 5}, {60, 5}, {60, 60}, {5, 60}}}});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(ran.err, HasSubstr("[outline-off-surface]"));
}

TEST(BadOutline, CrossingItself) {
  const Ran ran = MeasureWound({{"polygon_px", {{900, 600}, {1200, 900}, {1200, 600}, {900, 900}}}});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("crosses itself"));
}

TEST(BadOutline, TheGoodOneIsMeasured) {
  // The refusals above would mean little if nothing passed.
  const Ran ran = MeasureWound(nlohmann::json::parse(ReadText(Scene::Get().outline())));
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(ran.Json().at("analysis"), "wound");
}

TEST(BadSession, Unknown) {
  const TempDir folder;
  const std::string study = (folder / "study").string();
  ASSERT_EQ(Striae({"init", study, "--protocol", "TEST-01", "--title", "Test", "--sponsor", "Test", "--site", "TS"})
                .exit_code,
            0);
  const std::string nobody = "0f8fad5b-d9cb-469f-a165-70867728950e";
  const fs::path photograph = Scene::Get().photograph();
  const std::size_t files = FilesIn(study);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"import", "--session", nobody, photograph.string()},
        {"process", "--session", nobody},
        {"show", nobody},
        {"dicom", "export", "--session", nobody, "--out", (folder / "dicom").string()},
        {"report", "S404", "--out", (folder / "report.html").string()}}) {
    std::vector<std::string> all = {"-C", study};
    all.insert(all.end(), words.begin(), words.end());
    const Ran ran = Striae(all);
    EXPECT_EQ(ran.exit_code, 1) << words.front() << ran.err;
    EXPECT_EQ(ran.out, "") << words.front();
    EXPECT_THAT(ran.err, ::testing::StartsWith("striae: ")) << words.front();
  }
  EXPECT_EQ(FilesIn(study), files);
  EXPECT_FALSE(fs::exists(folder / "dicom"));
  EXPECT_FALSE(fs::exists(folder / "report.html"));
}

TEST(BadSession, NoStudyInTheFolder) {
  const TempDir folder;
  const Ran ran = Striae({"-C", folder.path().string(), "status"});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("init"));
  EXPECT_EQ(FilesIn(folder.path()), 0U);
}

}  // namespace
}  // namespace striae
