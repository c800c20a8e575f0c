// The paper's model and its optimiser, and whether the uncertainties hold the truth.
#include <cmath>

#include <gtest/gtest.h>

#include "core/optics.h"
#include "tests/reconstruct/calibration_scene.h"

namespace striae::reconstruct {
namespace {

using testing::DomedPlate;
using testing::kPhaseNoise_stripes;
using testing::Nominal;
using testing::PhotographPlate;
using testing::TrueRig;

TEST(SolveCalibration, FitsTheAngularModelAsWellAsItsShapeAllows) {
  const auto shape = ReferenceShape::FromMesh(DomedPlate());
  ASSERT_TRUE(shape);
  SolveOptions options;
  options.model = ProjectorModel::Kind::kAngular;
  // A flat grating is not equally spaced in the angle: OPTICS expects several mm in the corners, so tenths of a stripe.
  const auto fit = SolveCalibration(*shape, PhotographPlate(*shape, 7, 30), Nominal(), options);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(fit->calibration.projector.kind, ProjectorModel::Kind::kAngular);
  EXPECT_GT(fit->sd_stripes, 3 * kPhaseNoise_stripes);
  EXPECT_LT(fit->sd_stripes, 0.5);
  EXPECT_NEAR(1 / fit->calibration.projector.delta_a_rad, 527, 0.05 * 527);
  Calibration file = fit->calibration;
  file.near_mm = 880, file.far_mm = 1150;  // known to the caller, from the object's span
  EXPECT_TRUE(CalibrationFromJson(ToJsonText(file)));
  // It measures within its own deviations, through the same optics as any calibration.
  const StripeOptics truth(TrueRig()), found(fit->calibration);
  const auto depth = found.DepthAt(RayOf(fit->calibration.camera, {2100, 1400}),
                                   *truth.OrderAt(1000 * RayOf(TrueRig().camera, {2100, 1400})));
  ASSERT_TRUE(depth);
  EXPECT_NEAR(*depth, 1000, 8);  // half a stripe
}

TEST(SolveCalibrationLong, PowellFindsTheSameRigEveryTime) {
  const auto shape = ReferenceShape::FromMesh(DomedPlate());
  ASSERT_TRUE(shape);
  const auto views = PhotographPlate(*shape, 5, 45);
  SolveOptions options;
  options.optimizer = Optimizer::kPowell;
  int told = 0;
  options.progress = [&](double share, const std::string&) {
    EXPECT_GE(share, 0);
    EXPECT_LE(share, 1.01);
    ++told;
  };
  const auto fit = SolveCalibration(*shape, views, Nominal(), options);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_GT(told, 10);
  // Without a derivative it ends a little before the minimum: the noise is 0.01.
  EXPECT_LT(fit->sd_stripes, 2 * kPhaseNoise_stripes);
  EXPECT_EQ(ToJsonText(fit->calibration), ToJsonText(SolveCalibration(*shape, views, Nominal(), options)->calibration));
}

TEST(SolveCalibrationLong, ItsUncertaintiesHoldTheTruth) {
  const auto shape = ReferenceShape::FromMesh(DomedPlate());
  ASSERT_TRUE(shape);
  const auto fit = SolveCalibration(*shape, PhotographPlate(*shape, 9, 25), Nominal());
  ASSERT_TRUE(fit && fit->calibration.uncertainty);
  Calibration truth = TrueRig(), found = fit->calibration;
  const auto& uncertainty = *fit->calibration.uncertainty;
  int within = 0;
  for (std::size_t i = 0; i < uncertainty.names.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double u = std::sqrt(uncertainty.covariance(at, at));
    const double error =
        *CalibrationParameter(found, uncertainty.names[i]) - *CalibrationParameter(truth, uncertainty.names[i]);
    EXPECT_GT(u, 0) << uncertainty.names[i];
    EXPECT_LT(std::abs(error), 5 * u) << uncertainty.names[i];
    within += std::abs(error) < 2 * u ? 1 : 0;
  }
  EXPECT_EQ(uncertainty.names.size(), 15U);
  EXPECT_GE(within, 11);  // 95 % of 15 would be 14; they are correlated, so misses come together
}

}  // namespace
}  // namespace striae::reconstruct
