// The program against photographs that another renderer made with a rig of its own (practice set): surfaces against
// the true depth, wounds against the true volume, heads against the true rotation. The true rig is given.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/ply.h"
#include "tests/support/program.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_data.h"

namespace striae {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Ran;
using testing::RunProgram;
using testing::TempDir;
using testing::TestData;

constexpr int kTruthStep = 8;  ///< *.depth8.tiff: the true depth at every 8th sensor pixel

fs::path Program() { return fs::path(STRIAE_BINARY_DIR) / "striae"; }

json ReadJson(const fs::path& path) { return json::parse(std::ifstream(path)); }

Surface ReadSurface(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  const std::vector<std::uint8_t> bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  auto surface = DecodePly(bytes);
  if (!surface) throw std::runtime_error(surface.error().message);
  return *std::move(surface);
}

Ran Reconstruct(const fs::path& image, const std::string& rig, const fs::path& out) {
  return RunProgram(Program(), {"reconstruct", image.string(), "--calibration", TestData("practice/" + rig).string(),
                                "--out", out.string(), "--json"});
}

/// Depth errors (mm) at the pixels whose truth is known. Untrimmed.
std::vector<double> DepthErrors(const Surface& surface, const fs::path& truth_file) {
  const cv::Mat truth = cv::imread(truth_file.string(), cv::IMREAD_UNCHANGED);
  std::vector<double> errors;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (surface.col[i] % kTruthStep != 0 || surface.row[i] % kTruthStep != 0) continue;
    const float depth = truth.at<float>(surface.row[i] / kTruthStep, surface.col[i] / kTruthStep);
    if (std::isfinite(depth) && depth > 0) errors.push_back(surface.point_in_camera[i].z() - depth);
  }
  return errors;
}

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double StandardDeviation(const std::vector<double>& values) {
  const double mean = Mean(values);
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

struct WoundVisit {
  fs::path image;
  json truth;
};

std::vector<WoundVisit> WoundVisits() {
  std::vector<WoundVisit> visits;
  for (const char* wound : {"practice/wound_0", "practice/wound_1"}) {
    for (const json& truth : ReadJson(TestData(wound) / "truth.json")) {
      visits.push_back({TestData(wound) / truth.at("image").get<std::string>(), truth});
    }
  }
  return visits;
}

double ValueOf(const json& report, const std::string& name) {
  for (const json& measurement : report.at("measurements")) {
    if (measurement.at("name") == name) return measurement.at("value");
  }
  throw std::runtime_error("no " + name);
}

TEST(Practice, LimbsAndTheirWoundsAtOneMetre) {
  STRIAE_NEED_DATA("practice/wound_0/truth.json");
  const TempDir folder;
  std::vector<double> volume_errors;
  for (const auto& [image, truth] : WoundVisits()) {
    const fs::path ply = folder / "limb.ply";
    const Ran ran = Reconstruct(image, "true_small.json", ply);
    ASSERT_EQ(ran.exit_code, 0) << image << ran.err;
    const auto errors = DepthErrors(ReadSurface(ply), fs::path(image).replace_extension(".depth8.tiff"));
    ASSERT_GT(errors.size(), 10000U) << image;  // a limb fills some 20,000 of the truth's samples
    // The paper's apparatus had 0.5 mm; a plain FTP with the true rig is to stay under 0.25 mm. A wrong stripe order
    // would be 16 mm of bias, so the mean guards that too.
    EXPECT_LT(StandardDeviation(errors), 0.25) << image;
    EXPECT_LT(std::abs(Mean(errors)), 0.25) << image;

    std::ofstream(folder / "outline.json") << json{{"polygon_px", truth.at("outline_px")}};
    const Ran wound = RunProgram(
        Program(), {"measure", "wound", ply.string(), "--outline", (folder / "outline.json").string(), "--json"});
    ASSERT_EQ(wound.exit_code, 0) << image << wound.err;
    const double volume = ValueOf(wound.Json(), "volume"), true_volume = truth.at("volume_ml");
    volume_errors.push_back(100 * std::abs(volume / true_volume - 1));
    std::cout << image.parent_path().filename() << "/" << image.filename() << ": depth sd " << StandardDeviation(errors)
              << " mm, mean " << Mean(errors) << " mm; volume " << volume << " mL, true " << true_volume << " mL, area "
              << ValueOf(wound.Json(), "area") << " cm2, true " << truth.at("skin_area_cm2") << " cm2\n";
  }
  EXPECT_LT(Median(volume_errors), 6);  // percent; the published chain had 11 %
}

TEST(Practice, HeadAgainstTorsoAtTwoMetres) {
  STRIAE_NEED_DATA("practice/head/truth.json");
  const TempDir folder;
  const json poses = ReadJson(TestData("practice/head/truth.json"));
  const auto surface_of = [&](const json& pose) { return folder / (pose.at("image").get<std::string>() + ".ply"); };
  for (const json& pose : poses) {
    const Ran ran = Reconstruct(TestData("practice/head") / pose.at("image").get<std::string>(), "true_large.json",
                                surface_of(pose));
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
  }
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const json& pose = poses[i];
    const Ran ran =
        RunProgram(Program(), {"measure", "head", surface_of(poses[0]).string(), surface_of(pose).string(), "--json"});
    Eigen::Matrix3d truth, measured;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) truth(r, c) = pose.at("rotation_matrix_camera").at(r).at(c);
    }
    const double turned_deg = Eigen::AngleAxisd(truth).angle() * 180 / M_PI;
    if (turned_deg > 16 && ran.exit_code == 1) continue;  // refusing a large turn is allowed, a wrong number is not
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
    const json report = ran.Json();
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) measured(r, c) = report.at("rotation_matrix").at(r).at(c);
    }
    const double error_deg = Eigen::AngleAxisd(measured * truth.transpose()).angle() * 180 / M_PI;
    std::cout << pose.at("image") << ": turned " << turned_deg << " deg, error " << error_deg << " deg, uncertainty "
              << report.at("measurements").at(0).at("uncertainty") << " deg\n";
    EXPECT_LT(error_deg, 1.5) << pose.at("image");  // the published apparatus had 2 degrees
  }
}

}  // namespace
}  // namespace striae
