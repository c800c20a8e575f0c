// What surrounds the calibration's solver: samples from a phase, and the comparison with the reference afterwards.
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "core/optics.h"
#include "reconstruct/calibrate/photographs.h"

namespace striae::reconstruct {
namespace {

constexpr float kTwoPi = 2 * std::numbers::pi_v<float>;

/// A plate of 200 x 160 mm with one dome of 15 mm; 2 mm triangles.
Surface Plate() {
  constexpr int kCols = 101, kRows = 81;
  Surface mesh;
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < kCols; ++col) {
      const double x = 2 * (col - 50), y = 2 * (row - 40), r2 = (x * x + y * y) / (40.0 * 40.0);
      const double z = r2 < 1 ? -15 * std::pow(1 - r2, 2) : 0;
      mesh.point_in_camera.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
    }
  }
  for (std::uint32_t row = 0; row + 1 < kRows; ++row) {
    for (std::uint32_t col = 0; col + 1 < kCols; ++col) {
      const std::uint32_t i = row * kCols + col;
      mesh.faces.push_back({i, i + kCols, i + 1});
      mesh.faces.push_back({i + 1, i + kCols, i + kCols + 1});
    }
  }
  return mesh;
}

CalibrationFit StandingAt(double distance_mm) {
  CalibrationFit fit;
  fit.calibration.image_width_px = 400;
  fit.calibration.image_height_px = 300;
  fit.calibration.camera = {1500, 1500, 199.5, 149.5, 0, 0, 0, 0};
  fit.object_in_camera_mm = {0, 0, distance_mm};
  return fit;
}

/// A surface on every fourth pixel, `shift_mm` of depth behind a flat plane at `distance_mm`.
Surface FlatSurface(const CalibrationFit& fit, double distance_mm, double shift_mm) {
  Surface surface;
  surface.sensor_width_px = fit.calibration.image_width_px;
  surface.sensor_height_px = fit.calibration.image_height_px;
  for (int row = 0; row < surface.sensor_height_px; row += 4) {
    for (int col = 0; col < surface.sensor_width_px; col += 4) {
      const Eigen::Vector3d ray = RayOf(fit.calibration.camera, {static_cast<double>(col), static_cast<double>(row)});
      surface.point_in_camera.push_back(((distance_mm + shift_mm) * ray).cast<float>());
      surface.col.push_back(static_cast<std::uint16_t>(col));
      surface.row.push_back(static_cast<std::uint16_t>(row));
    }
  }
  return surface;
}

TEST(CompareWithReference, TakesTheDepthAlongTheRayOverEveryPointThatMeetsTheReference) {
  const auto shape = ReferenceShape::FromMesh(Plate());
  ASSERT_TRUE(shape);
  const CalibrationFit fit = StandingAt(1000);
  const Differences found = CompareWithReference(FlatSurface(fit, 1000 + 25, 0.5), fit, *shape, 25);
  // The plate of 200 x 160 mm at 1025 mm covers 293 x 234 pixels: every fourth, 73 x 58, in each direction.
  EXPECT_NEAR(static_cast<double>(found.values_mm.size()), 73 * 58, 150);
  const Spread spread = SpreadOf(found.values_mm);
  EXPECT_NEAR(spread.median, 0.5, 1e-3);  // most of the plate is flat; floats of 1000 mm resolve 6e-5
  // On the dome's top the reference is 15 mm nearer than the flat surface; nothing is trimmed.
  // (The nearest sampled pixel looks 1.7 mm beside the top: 0.05 mm lower.)
  EXPECT_NEAR(*std::max_element(found.values_mm.begin(), found.values_mm.end()), 15.5, 0.1);
  EXPECT_TRUE(std::isnan(found.map_mm(0, 0)));  // the picture's corner looks past the plate
  EXPECT_NEAR(found.map_mm(found.map_mm.width() / 2, found.map_mm.height() / 2), 15.5, 1.5);
}

TEST(ObjectSpan, IncludesTheReliefAndTheWholeSlide) {
  const auto shape = ReferenceShape::FromMesh(Plate());
  ASSERT_TRUE(shape);
  const CalibrationFit fit = StandingAt(1000);
  std::vector<CalibrationView> views(2);
  views[1].position_mm = 200;
  for (auto& view : views) {
    for (double row = 0; row < 300; row += 10) {
      for (double col = 0; col < 400; col += 10) view.samples.push_back({{col, row}, 0});
    }
  }
  const DepthSpan span = ObjectSpan(fit, *shape, views);
  EXPECT_NEAR(span.near_mm, 985, 0.5);  // the dome's top, seen by a pixel within 3 mm of it
  EXPECT_NEAR(span.far_mm, 1200, 1e-6);
}

TEST(SpreadOf, CountsEverythingInTheSdAndHalfInTheRobustOne) {
  std::vector<float> values(1000);
  for (int i = 0; i < 1000; ++i) values[static_cast<std::size_t>(i)] = i % 2 == 0 ? 1.0F : -1.0F;
  for (int i = 0; i < 10; ++i) values[static_cast<std::size_t>(i)] = i % 2 == 0 ? 100.0F : -100.0F;
  const Spread spread = SpreadOf(values);
  EXPECT_NEAR(spread.mean, 0, 1e-9);
  EXPECT_NEAR(spread.sd, std::sqrt((990 + 10 * 1e4) / 1000), 1e-9);
  EXPECT_NEAR(spread.robust_sd, 1.4826 * 2, 1e-6);  // the median of +-1 is one of them, the others are 0 or 2 away
  EXPECT_EQ(SpreadOf({}).count, 0U);
}

TEST(JudgeSpread, RefusesTheWrongMeshAndAPhotographOutOfPlace) {
  const Spread fair{1000, 0, 0.06, 0, 0.01};
  EXPECT_TRUE(JudgeSpread(fair, {fair, fair, fair}, 1000));
  Spread wrong_mesh = fair;
  wrong_mesh.robust_sd = 4;  // OPTICS: what wrong integers converge to
  EXPECT_FALSE(JudgeSpread(wrong_mesh, {fair, fair, fair}, 1000));
  Spread misplaced = fair;
  misplaced.median = 0.8;
  const Status refused = JudgeSpread(fair, {fair, misplaced, fair}, 1000);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kBadCalibration);
  EXPECT_THAT(refused.error().message, ::testing::HasSubstr("photograph 2"));
  EXPECT_FALSE(JudgeSpread(Spread{}, {fair}, 1000)) << "nothing compared";
}

/// Stripes of 20 px over the whole picture, in two regions that column 200 separates.
PhaseResult TwoSheets() {
  PhaseResult phase;
  phase.carrier_period_px = 20;
  phase.mask = Mask(400, 300, 1);
  phase.misfit = Mask(400, 300, 0);
  phase.amplitude = ImageF(400, 300, 0.2F);
  phase.background = ImageF(400, 300, 0.5F);
  phase.noise = 0.001;
  phase.unwrapped.phase = ImageF(400, 300);
  phase.unwrapped.region = Image<std::int32_t>(400, 300, 0);
  phase.unwrapped.regions = 2;
  for (int row = 0; row < 300; ++row) {
    for (int col = 0; col < 400; ++col) {
      phase.unwrapped.phase(col, row) = kTwoPi * (static_cast<float>(row) / 20 + (col > 200 ? 5 : 0));
      phase.unwrapped.region(col, row) = col > 200 ? 1 : 0;
    }
    phase.mask(200, row) = 0;
    phase.unwrapped.region(200, row) = -1;
  }
  return phase;
}

TEST(ViewFromPhase, SamplesOneSheetAwayFromItsRim) {
  const CalibrationView view = ViewFromPhase(TwoSheets(), 50);
  EXPECT_EQ(view.position_mm, 50);
  ASSERT_GT(view.samples.size(), 1000U);
  for (const OrderSample& sample : view.samples) {
    EXPECT_LT(sample.pixel.x(), 200 - 5);  // the other sheet has a whole number of its own
    EXPECT_GT(sample.pixel.y(), 9);        // half a period: the window reaches beyond the picture there
    EXPECT_NEAR(sample.order, sample.pixel.y() / 20, 1e-5);
  }
}

TEST(ViewFromPhase, LeavesOutStepsAndNoise) {
  PhaseResult phase = TwoSheets();
  for (int row = 100; row < 300; ++row) {  // a step of a third of a stripe at row 100
    for (int col = 0; col < 200; ++col) phase.unwrapped.phase(col, row) += kTwoPi / 3;
  }
  for (int row = 0; row < 300; ++row) phase.amplitude(21, row) = 0.002F;  // half a radian of noise
  for (const OrderSample& sample : ViewFromPhase(phase, 0).samples) {
    EXPECT_GT(std::abs(sample.pixel.y() - 99.5), 9.0);
    EXPECT_NE(sample.pixel.x(), 21);
  }
}

}  // namespace
}  // namespace striae::reconstruct
