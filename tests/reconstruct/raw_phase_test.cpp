// A raw file of stripes through the real decoder to their phase.
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "app/io/photograph.h"
#include "reconstruct/phase.h"
#include "tests/support/dng.h"

namespace striae::reconstruct {
namespace {

using striae::testing::DngOptions;
using striae::testing::MakeDng;

constexpr double kPeriod_px = 16.4, kMean = 5000, kContrast = 0.8;

/// The sensor's linear value under a sinusoidal grating whose stripes run along the rows, all colours alike.
std::uint16_t Stripes(int, int row, int) {
  return static_cast<std::uint16_t>(
      std::lround(kMean * (1 + kContrast * std::cos(2 * std::numbers::pi * row / kPeriod_px))));
}

TEST(RawPhase, IsThatOfTheSensorsRowsInLinearLight) {
  // The file asks for a turn by a quarter, which would lay the stripes along the columns: it is not made.
  const auto photograph = app::DecodePhotograph(MakeDng(DngOptions{.width = 360, .height = 480}, Stripes));
  ASSERT_TRUE(photograph) << photograph.error().message;
  const auto phase = MeasurePhase(*photograph);
  ASSERT_TRUE(phase) << phase.error().message;
  EXPECT_EQ(phase->direction, StripeDirection::kHorizontal);
  EXPECT_NEAR(phase->carrier_period_px, kPeriod_px, 0.1);
  const double white = 16383;
  double whole = 0;
  for (int row = 60; row < 420; row += 7) {
    for (int col = 20; col < 340; col += 40) {
      ASSERT_NE(phase->mask(col, row), 0);
      const double miss = phase->unwrapped.phase(col, row) / (2 * std::numbers::pi) - row / kPeriod_px;
      if (row == 60 && col == 20) whole = std::round(miss);
      // A tenth of a pixel. Half a pixel of shift between the colours would be 0.03 stripe.
      EXPECT_NEAR(miss, whole, 0.1 / kPeriod_px) << row;
      // Linear light; interpolation between the pixels of one colour (two apart) takes a little of the contrast.
      EXPECT_NEAR(phase->background(col, row), kMean / white, 0.01 * kMean / white);
      EXPECT_NEAR(phase->ModulationAt(static_cast<std::size_t>(row) * 360 + static_cast<std::size_t>(col)), kContrast,
                  0.05);
    }
  }
}

}  // namespace
}  // namespace striae::reconstruct
