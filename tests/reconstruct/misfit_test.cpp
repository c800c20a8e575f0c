// What the stripes do not explain of the light: where it marks, and where it must not.
#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "reconstruct/phase.h"

namespace striae::reconstruct {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kWidth = 160, kHeight = 600, kMiddle = kHeight / 2;
constexpr double kPeriod_px = 18;

/// Linear light of stripes whose order along a column is given.
Photograph Stripes(const std::function<double(int)>& order) {
  Photograph photograph{ImageF(kWidth, kHeight), ImageRgb(kWidth, kHeight), 1.0F, true};
  for (int row = 0; row < kHeight; ++row) {
    const double light = 0.4 + 0.3 * std::cos(2 * kPi * order(row));
    for (int col = 0; col < kWidth; ++col) photograph.luminance(col, row) = static_cast<float>(light);
  }
  return photograph;
}

float MisfitAtRow(const PhaseResult& phase, int row) {
  return phase.MisfitAt(static_cast<std::size_t>(row) * kWidth + kWidth / 2);
}

bool FitsAtRow(const PhaseResult& phase, int row) {
  return phase.FitsAt(static_cast<std::size_t>(row) * kWidth + kWidth / 2);
}

TEST(Misfit, IsSmallOnASlopeThatTheWindowDims) {
  // From 0.7 to 1.5 of the carrier's frequency: the Hann window takes off up to six tenths of the amplitude there.
  const auto order = [](int row) {
    const double x = (row - kMiddle) / static_cast<double>(kMiddle);
    return (row + 0.2 * kMiddle * x * x) / kPeriod_px;
  };
  const auto phase = MeasurePhase(Stripes(order));
  ASSERT_TRUE(phase) << phase.error().message;
  // Without noise what is left comes from the background's running mean, where the stripes are not the carrier's.
  for (int row = 60; row < kHeight - 60; ++row) EXPECT_LT(MisfitAtRow(*phase, row), 0.1F) << row;
}

TEST(Misfit, MarksAStepWithinItsWindowAndNothingFarther) {
  for (const double step : {0.25, 0.5}) {
    const auto phase = MeasurePhase(Stripes([&](int row) { return row / kPeriod_px + (row < kMiddle ? 0 : step); }));
    ASSERT_TRUE(phase) << phase.error().message;
    EXPECT_FALSE(FitsAtRow(*phase, kMiddle)) << step;
    // Beyond the window's kernel (two periods) and what the misfit is read over (three quarters of one).
    for (const int away : {-60, 60}) EXPECT_LT(MisfitAtRow(*phase, kMiddle + away), 0.02F) << step << " " << away;
  }
}

TEST(Misfit, BoundsTheErrorOfThePhaseAtAStep) {
  // Within a period of the step the phase is off by up to a fifth of a stripe; where it counts as measured the error
  // is of the misfit's size / (2 pi sqrt(2)). Three of them: the two agree in size, not place by place.
  constexpr double kStep = 0.3;
  const auto phase = MeasurePhase(Stripes([](int row) { return row / kPeriod_px + (row < kMiddle ? 0 : kStep); }));
  ASSERT_TRUE(phase) << phase.error().message;
  int measured = 0;
  for (int row = kMiddle - 40; row < kMiddle + 40; ++row) {
    if (!FitsAtRow(*phase, row) || phase->mask(kWidth / 2, row) == 0) continue;
    const double turns = static_cast<double>(phase->unwrapped.phase(kWidth / 2, row)) / (2 * kPi) - row / kPeriod_px -
                         (row < kMiddle ? 0 : kStep);
    const double error = std::abs(turns - std::round(turns));
    EXPECT_LT(error, 0.002 + 3 * static_cast<double>(MisfitAtRow(*phase, row)) / (2 * kPi * std::numbers::sqrt2))
        << row;
    ++measured;
  }
  EXPECT_GT(measured, 20);
}

TEST(Misfit, MarksWhereTheStripesEnd) {
  Photograph photograph = Stripes([](int row) { return row / kPeriod_px; });
  for (int row = kMiddle; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) photograph.luminance(col, row) = 0.4F;
  }
  const auto phase = MeasurePhase(photograph);
  ASSERT_TRUE(phase) << phase.error().message;
  EXPECT_LT(MisfitAtRow(*phase, kMiddle / 2), 0.02F);
  for (int row = kMiddle; row < kMiddle + kPeriod_px / 2; ++row) EXPECT_FALSE(FitsAtRow(*phase, row)) << row;
}

TEST(Misfit, LeavesWhatDoesNotFitOutOfTheMeasuredMaskOnly) {
  const auto phase = MeasurePhase(Stripes([](int row) { return row / kPeriod_px + (row < kMiddle ? 0 : 0.25); }));
  ASSERT_TRUE(phase) << phase.error().message;
  const Mask measured = MeasuredMask(*phase);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    ASSERT_EQ(measured.pixels()[i] != 0, phase->mask.pixels()[i] != 0 && phase->FitsAt(i));
  }
  EXPECT_EQ(measured(kWidth / 2, kMiddle), 0);
}

}  // namespace
}  // namespace striae::reconstruct
