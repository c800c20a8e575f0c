// The practice set: another program's bodies, poses and rig. Its depth maps stand in for a reconstruction, so that this
// part is judged alone.
#include <cmath>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "analysis/head/measure.h"
#include "core/calibration.h"
#include "tests/support/depth_map.h"
#include "tests/support/files.h"
#include "tests/support/test_data.h"

namespace striae::head {
namespace {

Eigen::Matrix3d Matrix(const nlohmann::json& rows) {
  Eigen::Matrix3d m;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) m(static_cast<int>(i), static_cast<int>(k)) = rows[i][k].get<double>();
  }
  return m;
}

TEST(PracticeHeads, EveryPoseIsFoundThroughReconstructionNoise) {
  STRIAE_NEED_DATA("practice/head/truth.json");
  const auto calibration = CalibrationFromJson(testing::ReadText(testing::TestData("practice/true_large.json")));
  ASSERT_TRUE(calibration);
  const auto truth = nlohmann::json::parse(testing::ReadText(testing::TestData("practice/head/truth.json")));
  const auto load = [&](int pose) {
    // 0.5 mm: what the Fourier stage leaves at 2 m on smooth skin.
    return testing::SurfaceFromDepthMap(
        testing::TestData("practice/head/pose_" + std::to_string(pose) + ".depth8.tiff"), calibration->camera, 0.5,
        static_cast<std::uint32_t>(pose));
  };
  const Surface neutral = load(0);
  for (int pose = 1; pose <= 4; ++pose) {
    const auto report = Measure(neutral, load(pose));
    ASSERT_TRUE(report) << pose << ": " << report.error().Describe();
    const auto& entry = truth[static_cast<std::size_t>(pose)];
    const Eigen::Matrix3d difference =
        Matrix(report->details["rotation_matrix"]).transpose() * Matrix(entry["rotation_matrix_camera"]);
    // Without stripes in between the bar of 1.5 deg must keep a wide margin: p95 was 0.27 deg at this noise in trials.
    EXPECT_LT(Eigen::AngleAxisd(difference).angle() * 180 / M_PI, 0.3) << "pose " << pose;
    // Signs: the set's yaw is positive to the subject's right, its pitch chin down, its roll to the subject's left; the
    // torso moves by about one degree as well, and angles of one pose mix by another two.
    if (std::abs(entry["yaw_deg"].get<double>()) >= 10) {
      EXPECT_NEAR(report->Find("rotation")->value, -entry["yaw_deg"].get<double>(), 3);
    }
    if (std::abs(entry["pitch_deg"].get<double>()) >= 10) {
      EXPECT_NEAR(report->Find("flexion")->value, entry["pitch_deg"].get<double>(), 3);
    }
    if (std::abs(entry["roll_deg"].get<double>()) >= 10) {
      EXPECT_NEAR(report->Find("tilt")->value, -entry["roll_deg"].get<double>(), 3);
    }
  }
}

}  // namespace
}  // namespace striae::head
