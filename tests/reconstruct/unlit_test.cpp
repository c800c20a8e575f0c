// A body's outline is a step of brightness, and a step holds every frequency, the carrier's too: where no stripe falls,
// the ghost of it along the outline must not become surface.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "reconstruct/phase.h"

namespace striae::reconstruct {
namespace {

constexpr int kWidth = 320, kHeight = 360, kLightEnds = 180;

/// A slanting limb on black; stripes (rows) fall on it up to column kLightEnds, beyond there is only the room's light.
Photograph HalfLitLimb(double albedo) {
  Photograph photograph{ImageF(kWidth, kHeight), ImageRgb(kWidth, kHeight), 1.0F};
  for (int row = 0; row < kHeight; ++row) {
    for (int col = 0; col < kWidth; ++col) {
      const bool on_limb = std::abs(row - 180 + 0.4 * (col - 160)) < 100;
      double light = 0.002;
      if (on_limb && col < kLightEnds) {
        light = albedo * (0.5 + 0.4 * std::cos(2 * std::numbers::pi * row / 16.0));
      } else if (on_limb) {
        light = 0.07 * albedo;
      }
      // sRGB's encoding, as a camera writes it
      photograph.luminance(col, row) =
          static_cast<float>(light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055);
    }
  }
  return photograph;
}

int ValidPixels(const Mask& mask, int first_col, int last_col) {
  int valid = 0;
  for (int row = 0; row < mask.height(); ++row) {
    for (int col = first_col; col < last_col; ++col) valid += mask(col, row);
  }
  return valid;
}

TEST(Unlit, TheOutlineOfAnUnlitPartIsNoSurface) {
  const auto phase = MeasurePhase(HalfLitLimb(0.8));
  ASSERT_TRUE(phase) << phase.error().Describe();
  EXPECT_EQ(ValidPixels(phase->mask, kLightEnds + 2, kWidth), 0);  // 2 px: the mask's opening
  EXPECT_GT(ValidPixels(phase->mask, 5, kLightEnds), 170 * 200 * 0.95);
}

TEST(Unlit, DarkSkinUnderStripesIsSurface) {
  // A twelfth of the light: what counts is the stripes' contrast, not their brightness.
  const auto phase = MeasurePhase(HalfLitLimb(0.07));
  ASSERT_TRUE(phase) << phase.error().Describe();
  EXPECT_EQ(ValidPixels(phase->mask, kLightEnds + 2, kWidth), 0);
  EXPECT_GT(ValidPixels(phase->mask, 5, kLightEnds), 170 * 200 * 0.95);
}

TEST(Unlit, LightThatSpillsIntoAShadowIsNoSurface) {
  // A chin's shadow on the neck: stripes above it, and below it half a stripe on. What the Fourier window carries into
  // the shadow has the chin's phase, and would be read as chin a hand's breadth before the neck.
  constexpr int kFirst = 150, kLast = 190;
  constexpr double kPeriod = 16;
  Photograph photograph{ImageF(kWidth, kHeight), ImageRgb(kWidth, kHeight), 1.0F};
  for (int row = 0; row < kHeight; ++row) {
    const bool shadow = row >= kFirst && row < kLast;
    const double turns = row / kPeriod + (row < kFirst ? 0 : 0.5);
    const double light = shadow ? 0.004 : 0.8 * (0.3 + 0.25 * std::cos(2 * std::numbers::pi * turns));
    const double encoded = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
    for (int col = 0; col < kWidth; ++col) photograph.luminance(col, row) = static_cast<float>(encoded);
  }
  const auto phase = MeasurePhase(photograph);
  ASSERT_TRUE(phase) << phase.error().Describe();
  int spilled = 0, lit = 0;
  for (int row = 0; row < kHeight; ++row) {
    const bool shadow = row >= kFirst + 4 && row < kLast - 4;  // a quarter of a period: the window's own sharpness
    (shadow ? spilled : lit) += phase->mask(kWidth / 2, row);
  }
  EXPECT_EQ(spilled, 0);
  EXPECT_GT(lit, 0.9 * (kHeight - (kLast - kFirst)));
}

}  // namespace
}  // namespace striae::reconstruct
