// The optics against photographs that another program rendered: stripes lie where the formulas put them.
#include <algorithm>
#include <cmath>
#include <complex>
#include <fstream>
#include <iostream>
#include <numbers>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/optics.h"
#include "tests/support/test_data.h"

namespace striae::rig {
namespace {

constexpr int kDepthStep = 8;  // practice: depth at every 8th sensor pixel
constexpr double kWindow = 6;  // stripes a phase is taken over

Calibration ReadRig(const std::string& name) {
  std::ifstream file(testing::TestData(name));
  std::stringstream text;
  text << file.rdbuf();
  auto calibration = CalibrationFromJson(text.str());
  EXPECT_TRUE(calibration);
  return calibration ? *calibration : Calibration{};
}

/// Phase of the photographed stripes against the predicted order, in stripes, over windows of whole stripes.
std::vector<double> Residuals(const cv::Mat& photo, const cv::Mat1f& depth, const Calibration& rig) {
  const StripeOptics optics(rig);
  std::vector<double> residuals;
  for (int i = 20; i + 20 < depth.cols; i += 7) {
    const int col = i * kDepthStep;
    std::complex<double> sum = 0;
    double mean = 0, from = NAN;
    std::vector<std::pair<double, double>> window;  // order, brightness
    for (int row = 0; row + kDepthStep < photo.rows; ++row) {
      const int j = row / kDepthStep;
      const double t = static_cast<double>(row % kDepthStep) / kDepthStep;
      const double z0 = depth(j, i), z1 = j + 1 < depth.rows ? depth(j + 1, i) : NAN;
      const double z = z0 + t * (z1 - z0);
      // Depth steps and what lies outside end a window.
      if (!std::isfinite(z) || std::abs(z1 - z0) > 4) {
        window.clear();
        continue;
      }
      const auto order = optics.OrderAt(z * RayOf(rig.camera, {static_cast<double>(col), static_cast<double>(row)}));
      if (!order || *order < 4 || *order > *rig.stripes - 5) {
        window.clear();
        continue;
      }
      if (window.empty()) from = *order;
      window.emplace_back(*order, photo.at<cv::Vec3b>(row, col)[1]);
      if (*order - from < kWindow) continue;
      mean = 0;
      for (const auto& [n, value] : window) mean += value / static_cast<double>(window.size());
      sum = 0;
      for (const auto& [n, value] : window) sum += (value - mean) * std::polar(1.0, -2 * std::numbers::pi * n);
      if (std::abs(sum) > 8.0 * static_cast<double>(window.size())) {  // not in shadow
        residuals.push_back(std::arg(sum) / (2 * std::numbers::pi));
      }
      window.clear();
    }
  }
  return residuals;
}

void ExpectStripesInPlace(const std::string& stem, const std::string& rig_name) {
  const cv::Mat photo =
      cv::imread(testing::TestData(stem + ".jpg").string(), cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  const cv::Mat1f depth = cv::imread(testing::TestData(stem + ".depth8.tiff").string(), cv::IMREAD_UNCHANGED);
  ASSERT_FALSE(photo.empty() || depth.empty());
  std::vector<double> residuals = Residuals(photo, depth, ReadRig(rig_name));
  ASSERT_GT(residuals.size(), 100U) << stem;
  double mean = 0;
  for (const double r : residuals) mean += r / static_cast<double>(residuals.size());
  std::vector<double> sizes;
  for (const double r : residuals) sizes.push_back(std::abs(r));
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2), sizes.end());
  ::testing::Test::RecordProperty("mean_stripes", std::to_string(mean));
  ::testing::Test::RecordProperty("median_absolute_stripes", std::to_string(sizes[sizes.size() / 2]));
  std::cout << stem << ": mean " << mean << ", median |residual| " << sizes[sizes.size() / 2] << " stripes in "
            << residuals.size() << " windows\n";
  // 0.01 stripe is 0.16 mm at 1 m; half a pixel of the wrong convention would be 0.03 (small) or 0.014 (large).
  EXPECT_LT(std::abs(mean), 0.01) << stem;
  EXPECT_LT(sizes[sizes.size() / 2], 0.02) << stem;
}

TEST(PracticeOptics, StripesOfAPlaneLieAtWholeOrders) {
  STRIAE_NEED_DATA("practice");
  ExpectStripesInPlace("practice/artefacts/plane_small", "practice/true_small.json");
}

TEST(PracticeOptics, StripesOnALimbLieAtWholeOrders) {
  STRIAE_NEED_DATA("practice");
  ExpectStripesInPlace("practice/wound_0/visit_0", "practice/true_small.json");
}

TEST(PracticeOptics, StripesOnABustLieAtWholeOrders) {
  STRIAE_NEED_DATA("practice");
  ExpectStripesInPlace("practice/head/pose_0", "practice/true_large.json");
}

}  // namespace
}  // namespace striae::rig
