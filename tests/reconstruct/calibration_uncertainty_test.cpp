// The calibration's share of a depth's uncertainty, against calibrations drawn from its covariance.
#include "reconstruct/calibration_uncertainty.h"

#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "core/optics.h"
#include "tests/reconstruct/fringes.h"

namespace striae::reconstruct {
namespace {

using striae::testing::SmallQuarterRig;

/// Invented: three parameters, two of them correlated.
Calibration Doubted() {
  Calibration rig = SmallQuarterRig();
  CalibrationUncertainty doubt;
  doubt.names = {"camera.fx", "projector.center_y", "projector.center_order"};
  doubt.covariance.resize(3, 3);
  doubt.covariance << 4, 0, 0, 0, 0.01, 0.8 * 0.1 * 0.002, 0, 0.8 * 0.1 * 0.002, 4e-6;
  rig.uncertainty = doubt;
  return rig;
}

TEST(CalibrationUncertainty, IsTheScatterOverCalibrationsThatTheCovarianceAllows) {
  const Calibration rig = Doubted();
  const PixelDepth at{700, 200, 1000};
  const auto found = DepthUncertaintyOf(rig, {at});
  ASSERT_TRUE(found);
  const Eigen::Vector2d pixel(at.col, at.row);
  const auto order = StripeOptics(rig).OrderAt(at.depth_mm * RayOf(rig.camera, pixel));
  ASSERT_TRUE(order);
  const Eigen::MatrixXd root = rig.uncertainty->covariance.llt().matrixL();
  std::mt19937 engine(4);
  std::normal_distribution<double> normal;
  constexpr int kDraws = 4000;
  double squares = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Eigen::Vector3d off = root * Eigen::Vector3d(normal(engine), normal(engine), normal(engine));
    Calibration moved = rig;
    for (Eigen::Index i = 0; i < 3; ++i) {
      *CalibrationParameter(moved, rig.uncertainty->names[static_cast<std::size_t>(i)]) += off[i];
    }
    const auto depth = StripeOptics(moved).DepthAt(RayOf(moved.camera, pixel), *order);
    ASSERT_TRUE(depth);
    squares += (*depth - at.depth_mm) * (*depth - at.depth_mm);
  }
  // The scatter of 4000 draws is known to 1.1 %: three times that.
  EXPECT_NEAR(found->median_mm / std::sqrt(squares / kDraws), 1, 0.035);
  EXPECT_EQ(found->median_mm, found->largest_mm);  // of one point
}

TEST(CalibrationUncertainty, NothingIsSaidWithoutACovariance) {
  EXPECT_FALSE(DepthUncertaintyOf(SmallQuarterRig(), {{700, 200, 1000}}));
  EXPECT_FALSE(DepthUncertaintyOf(Doubted(), {}));
}

}  // namespace
}  // namespace striae::reconstruct
