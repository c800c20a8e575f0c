// `striae calibrate --board` on photographs of a printed board, rendered by the virtual rig.
#include <array>
#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <opencv2/aruco.hpp>

#include "acquire/rig/default_rig.h"
#include "acquire/rig/photograph_file.h"
#include "acquire/rig/render.h"
#include "core/calibration.h"
#include "core/optics.h"
#include "core/target.h"
#include "tests/app/striae_program.h"
#include "tests/support/temp_dir.h"

namespace striae {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using testing::Ran;
using testing::Striae;

constexpr double kDistance_mm = 1000;

/// The board's squares and markers as cells; 56 cells a square make its modules six and its margin seven cells wide.
rig::Decal Paint(const CharucoBoard& board) {
  constexpr int kSquare = 56, kModule = 6, kMargin = 7, kModules = 7;
  constexpr float kInk = 0.035F, kPaper = 0.78F;
  rig::Decal decal;
  decal.columns = board.columns * kSquare;
  decal.rows = board.rows * kSquare;
  decal.cell_mm = board.square_mm / kSquare;
  decal.reach_mm = 1;
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_50);
  std::vector<cv::Mat> markers(static_cast<std::size_t>(board.columns * board.rows));
  int id = 0;
  for (int i = 0; i < board.columns * board.rows; ++i) {
    if ((i / board.columns + i % board.columns) % 2 == 0) continue;  // the upper left square is black
    cv::aruco::drawMarker(dictionary, id++, kModules, markers[static_cast<std::size_t>(i)], 1);
  }
  for (int y = 0; y < decal.rows; ++y) {
    for (int x = 0; x < decal.columns; ++x) {
      const cv::Mat& marker = markers[static_cast<std::size_t>(y / kSquare * board.columns + x / kSquare)];
      const int u = x % kSquare - kMargin, v = y % kSquare - kMargin;
      const bool inside = u >= 0 && v >= 0 && u < kModules * kModule && v < kModules * kModule;
      const bool ink = marker.empty() || (inside && marker.at<std::uint8_t>(v / kModule, u / kModule) == 0);
      decal.albedo.push_back(ink ? kInk : kPaper);
    }
  }
  return decal;
}

struct Pose {
  double pitch_deg, yaw_deg, roll_deg, x, y, nearer;  ///< x, y, nearer as shares of the distance
};

std::string PhotographBoard(const Calibration& rig, const Pose& pose, int number, const testing::TempDir& folder) {
  const CharucoBoard board = BoardFor(RigRange::kSmall);
  const double w = board.columns * board.square_mm / 2 + 20, h = board.rows * board.square_mm / 2 + 20;
  rig::TriangleMesh mesh;
  mesh.vertex = {{-w, -h, 0}, {w, -h, 0}, {-w, h, 0}, {w, h, 0}};
  mesh.albedo.assign(4, Eigen::Vector3f::Constant(0.78F));
  rig::AppendGridTriangles(0, 2, 2, false, mesh);
  rig::ComputeNormals(mesh);
  mesh.decal.push_back(Paint(board));
  rig::Move(rig::RotationFromPose(pose.yaw_deg, pose.pitch_deg, pose.roll_deg),
            kDistance_mm * Eigen::Vector3d(pose.x, pose.y, 1 - pose.nearer), mesh);
  rig::RenderOptions options;
  options.sensor.seed = static_cast<std::uint64_t>(number);
  const auto rendering = rig::Render(mesh, rig, options);
  if (!rendering) return {};
  const auto jpeg = rig::EncodeJpeg(rendering->photograph, {}, 95);
  if (!jpeg) return {};
  const auto path = folder / ("board_" + std::to_string(number) + ".jpg");
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(jpeg->data()), static_cast<std::streamsize>(jpeg->size()));
  return path.string();
}

constexpr std::array<Pose, 12> kPoses = {{{0, 0, 0, 0, 0, 0},
                                          {18, 0, 0, .025, .006, -.03},
                                          {-18, 0, 0, -.025, 0, 0},
                                          {0, 20, 0, 0, .012, .04},
                                          {0, -20, 0, 0, -.012, -.05},
                                          {14, 14, 10, 0, .009, -.09},
                                          {-14, 14, -12, 0, -.009, .09},
                                          {14, -14, 90, 0, .006, -.06},
                                          {-14, -14, 95, 0, 0, .07},
                                          {0, 10, 180, 0, -.009, .1},
                                          {22, 8, 45, 0, 0, -.1},
                                          {-8, 22, -45, 0, 0, -.02}}};

std::vector<std::string> Command(const std::vector<std::string>& photographs, const std::string& out) {
  std::vector<std::string> command = {"calibrate", "--stripes", "140", "--period-um", "48",     "--distance-mm",
                                      "1000",      "--out",     out,   "--json",      "--board"};
  command.insert(command.end(), photographs.begin(), photographs.end());
  return command;
}

TEST(CalibrateBoardLong, FindsARigThatMeasuresWhatTheTrueOneMeasures) {
  const testing::TempDir folder;
  const Calibration truth = rig::ScaleSensor(rig::DefaultRig(rig::Range::kSmall).calibration, 0.4);
  std::vector<std::string> photographs;
  for (const Pose& pose : kPoses) {
    photographs.push_back(PhotographBoard(truth, pose, static_cast<int>(photographs.size()) + 1, folder));
    ASSERT_FALSE(photographs.back().empty());
  }
  const auto out = folder / "rig.json";
  const Ran ran = Striae(Command(photographs, out.string()));
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const json report = ran.Json();
  EXPECT_EQ(report.at("photographs").size(), 12U);
  EXPECT_LT(report.at("robust_sd_mm"), 0.05);
  std::ifstream stream(out);
  const auto found = CalibrationFromJson(std::string(std::istreambuf_iterator<char>(stream), {}));
  ASSERT_TRUE(found) << found.error().message;
  const StripeOptics optics(*found), true_optics(truth);
  double sum = 0, squares = 0, count = 0;
  for (const double z : {930.0, 1000.0, 1070.0}) {
    for (int x = 1; x < 8; ++x) {
      for (int y = 1; y < 8; ++y) {
        const Eigen::Vector2d pixel(truth.image_width_px * x / 8.0, truth.image_height_px * y / 8.0);
        const auto order = true_optics.OrderAt(z * RayOf(truth.camera, pixel));
        ASSERT_TRUE(order);
        if (*order < 0 || *order > 139) continue;
        const auto depth = optics.DepthAt(RayOf(found->camera, pixel), *order);
        ASSERT_TRUE(depth);
        sum += *depth - z;
        squares += std::pow(*depth - z, 2);
        count += 1;
      }
    }
  }
  const double mean = sum / count;
  EXPECT_LT(std::abs(mean), 2);  // absolute distance: within 2 mm at 1 m
  // Half of what the paper's reference object reaches, with 0.4 of the pixels a side.
  EXPECT_LT(std::sqrt(squares / count - mean * mean), 0.25);
}

TEST(CalibrateBoard, RefusesTooFewPhotographsAndPhotographsWithoutABoard) {
  const testing::TempDir folder;
  const Calibration rig = rig::ScaleSensor(rig::DefaultRig(rig::Range::kSmall).calibration, 0.3);
  const std::string one = PhotographBoard(rig, kPoses[0], 1, folder);
  ASSERT_FALSE(one.empty());
  const auto out = folder / "rig.json";
  const Ran few = Striae(Command({one, one}, out.string()));
  EXPECT_EQ(few.exit_code, 1);
  EXPECT_THAT(few.err, HasSubstr("fewer than five"));
  EXPECT_EQ(few.out, "");
  ASSERT_EQ(Striae({"simulate", "plane", "--out", (folder / "bare").string(), "--scale", "0.3"}).exit_code, 0);
  const Ran bare = Striae(Command({(folder / "bare" / "plane.jpg").string()}, out.string()));
  EXPECT_EQ(bare.exit_code, 1);
  EXPECT_THAT(bare.err, HasSubstr("corners of the board"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace striae
