#include "reconstruct/unwrap.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <gmock/gmock.h>

namespace striae::reconstruct {
namespace {

constexpr double kPi = std::numbers::pi;

float Wrapped(double phase) { return static_cast<float>(std::remainder(phase, 2 * kPi)); }

ImageF WrappedImage(int width, int height, const std::function<double(int, int)>& phase) {
  ImageF image(width, height);
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) image(col, row) = Wrapped(phase(col, row));
  }
  return image;
}

/// Largest difference from the truth after the common multiple of 2 pi is removed.
double WorstError(const Unwrapped& unwrapped, int region, const std::function<double(int, int)>& truth) {
  double offset = NAN, worst = 0;
  for (int row = 0; row < unwrapped.phase.height(); ++row) {
    for (int col = 0; col < unwrapped.phase.width(); ++col) {
      if (unwrapped.region(col, row) != region) continue;
      const double difference = unwrapped.phase(col, row) - truth(col, row);
      if (std::isnan(offset)) offset = 2 * kPi * std::round(difference / (2 * kPi));
      worst = std::max(worst, std::abs(difference - offset));
    }
  }
  return worst;
}

TEST(Unwrap, SmoothPhaseComesBackExactly) {
  const auto truth = [](int col, int row) {
    return 0.35 * row + 8 * std::exp(-0.001 * (std::pow(col - 60, 2) + std::pow(row - 50, 2)));
  };
  const auto unwrapped = Unwrap(WrappedImage(120, 100, truth), Mask(120, 100, 1));
  EXPECT_EQ(unwrapped.regions, 1);
  // The only error is float's: phases of up to 40 rad.
  EXPECT_LT(WorstError(unwrapped, 0, truth), 1e-5);
}

TEST(Unwrap, NoiseOnAPatchDoesNotReachTheRest) {
  // A patch of pure noise: the reliability path enters it last, so the sheet around it stays whole.
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> any(-kPi, kPi);
  const auto truth = [](int col, int row) { return 0.3 * row + 0.05 * col; };
  ImageF wrapped = WrappedImage(150, 120, truth);
  const auto noisy = [](int col, int row) { return std::hypot(col - 70, row - 60) < 18; };
  for (int row = 0; row < 120; ++row) {
    for (int col = 0; col < 150; ++col) {
      if (noisy(col, row)) wrapped(col, row) = static_cast<float>(any(engine));
    }
  }
  const auto unwrapped = Unwrap(wrapped, Mask(150, 120, 1));
  const double offset = unwrapped.phase(0, 0) - truth(0, 0);
  for (int row = 0; row < 120; ++row) {
    for (int col = 0; col < 150; ++col) {
      if (std::hypot(col - 70, row - 60) < 20) continue;
      ASSERT_NEAR(unwrapped.phase(col, row) - truth(col, row), offset, 1e-4) << col << ", " << row;
    }
  }
}

TEST(Unwrap, RegionsApartAreSheetsOfTheirOwnLargestFirst) {
  Mask mask(100, 60, 1);
  for (int row = 0; row < 60; ++row) mask(30, row) = 0;
  const auto truth = [](int col, int row) { return 0.4 * row + (col > 30 ? 17.0 : 0.0); };
  const auto unwrapped = Unwrap(WrappedImage(100, 60, truth), mask);
  EXPECT_EQ(unwrapped.regions, 2);
  EXPECT_EQ(unwrapped.region(60, 10), 0);
  EXPECT_EQ(unwrapped.region(10, 10), 1);
  EXPECT_EQ(unwrapped.region(30, 10), -1);
  EXPECT_TRUE(std::isnan(unwrapped.phase(30, 10)));
  EXPECT_LT(WorstError(unwrapped, 0, truth), 1e-5);
  EXPECT_LT(WorstError(unwrapped, 1, truth), 1e-5);
}

TEST(Unwrap, EveryPixelKeepsItsWrappedPhase) {
  std::mt19937 engine(11);
  std::uniform_real_distribution<float> any(-3.1415F, 3.1415F);
  ImageF wrapped(40, 40);
  for (float& phase : wrapped.pixels()) phase = any(engine);
  const auto unwrapped = Unwrap(wrapped, Mask(40, 40, 1));
  for (std::size_t i = 0; i < wrapped.size(); ++i) {
    const double turns = (unwrapped.phase.pixels()[i] - wrapped.pixels()[i]) / (2 * kPi);
    EXPECT_NEAR(turns, std::round(turns), 1e-5);
  }
}

TEST(Unwrap, NothingValidIsNoRegion) {
  const auto unwrapped = Unwrap(ImageF(8, 8, 0.0F), Mask(8, 8, 0));
  EXPECT_EQ(unwrapped.regions, 0);
}

}  // namespace
}  // namespace striae::reconstruct
