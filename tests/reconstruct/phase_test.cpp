#include "reconstruct/phase.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gmock/gmock.h>

namespace striae::reconstruct {
namespace {

constexpr double kPi = std::numbers::pi;

Photograph FromLight(int width, int height, const std::function<double(int, int)>& encoded) {
  Photograph photograph{ImageF(width, height), ImageRgb(width, height), 1.0F};
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) photograph.luminance(col, row) = static_cast<float>(encoded(col, row));
  }
  return photograph;
}

double Order(double position, double period) { return position / period + 0.4 * std::sin(position / 90); }

TEST(MeasurePhase, FindsDirectionAndCarrierOfEitherKind) {
  for (const bool horizontal : {true, false}) {
    const auto photograph = FromLight(
        400, 360, [&](int col, int row) { return 0.5 + 0.3 * std::cos(2 * kPi * (horizontal ? row : col) / 17.3); });
    const auto phase = MeasurePhase(photograph);
    ASSERT_TRUE(phase) << phase.error().message;
    EXPECT_EQ(phase->direction, horizontal ? StripeDirection::kHorizontal : StripeDirection::kVertical);
    EXPECT_NEAR(phase->carrier_period_px, 17.3, 0.17);  // a centre of gravity over some bins: a per cent
  }
}

TEST(MeasurePhase, FollowsTheStripesAndIsZeroAtTheirBrightCentres) {
  const auto photograph =
      FromLight(200, 600, [&](int, int row) { return 0.45 + 0.3 * std::cos(2 * kPi * Order(row, 18)); });
  const auto phase = MeasurePhase(photograph);
  ASSERT_TRUE(phase) << phase.error().message;
  // The sRGB decoding of a cosine adds harmonics; the window removes them but for a few hundredths of a radian. The
  // first and last period suffer from the line's end.
  for (int row = 40; row < 560; ++row) {
    const double turns = phase->unwrapped.phase(100, row) / (2 * kPi) - Order(row, 18);
    EXPECT_NEAR(turns, std::round(turns), 0.01) << row;
  }
}

TEST(MeasurePhase, IsFlatToASecondOrderWhereThePeriodChanges) {
  // phi = 2 pi (x / T + c x^2) about the middle. What is (1 - q d^2) at (1 + d) / T turns the phase by
  // q phi'' T^2 / (2 pi)^2: the background's removal has q = 1, Hann's window pi^2 / (4 w^2) more, the flattened one
  // none.
  constexpr double kPeriod = 18, kBend = 4e-5, kMiddle = 300;
  const auto order = [&](double x) { return (x - kMiddle) / kPeriod + kBend * (x - kMiddle) * (x - kMiddle); };
  auto photograph = FromLight(64, 601, [&](int, int row) { return 0.45 + 0.3 * std::cos(2 * kPi * order(row)); });
  photograph.linear = true;
  for (const bool flattened : {true, false}) {
    PhaseOptions options;
    options.window = {0.7, flattened};
    const auto phase = MeasurePhase(photograph, options);
    ASSERT_TRUE(phase) << phase.error().message;
    double sum = 0;  // over whole periods
    for (int row = 282; row < 318; ++row) {
      sum += std::remainder(phase->unwrapped.phase(30, row) - 2 * kPi * order(row), 2 * kPi) / 36;
    }
    const double carrier_px = phase->carrier_period_px;  // the window's own centre
    const double q = 1 + (flattened ? 0 : kPi * kPi / (4 * 0.7 * 0.7));
    const double expected = q * 4 * kPi * kBend * carrier_px * carrier_px / (4 * kPi * kPi);
    // 4e-4: a tenth of what the background takes, and higher orders.
    EXPECT_NEAR(sum, expected, 4e-4 + 0.1 * expected) << flattened;
  }
}

TEST(FollowPeriod, FindsTheStripesOwnPeriodOnASlope) {
  // A chirp: the frequency rises evenly from 0.8 to 1.2 of 1/18 along the line, so 5 and 95 % of it lie at 0.82
  // and 1.18.
  const auto order = [](double x) { return (0.8 * x + 0.2 * x * x / 600) / 18; };
  for (const bool horizontal : {true, false}) {
    const auto photograph = FromLight(horizontal ? 200 : 600, horizontal ? 600 : 200, [&](int col, int row) {
      return 0.45 + 0.3 * std::cos(2 * kPi * order(horizontal ? row : col));
    });
    const auto phase = MeasurePhase(photograph);
    ASSERT_TRUE(phase) << phase.error().message;
    const LocalPeriods periods = FollowPeriod(*phase);
    // 2.5 %: of the 33 periods up to one at either end, among the longest and the shortest, is no measurement; 5 % of
    // the rest lie beyond 0.831 and 1.169.
    EXPECT_NEAR(periods.fifth_px, 18 / 1.18, 0.025 * 18);
    EXPECT_NEAR(periods.ninety_fifth_px, 18 / 0.82, 0.025 * 18);
  }
}

TEST(MeasurePhase, LeavesOutWhatTheStripesDoNotReach) {
  const auto photograph = FromLight(
      300, 400, [&](int col, int row) { return col < 150 ? 0.02 : 0.45 + 0.3 * std::cos(2 * kPi * row / 18.0); });
  const auto phase = MeasurePhase(photograph);
  ASSERT_TRUE(phase) << phase.error().message;
  EXPECT_EQ(phase->mask(75, 200), 0);
  EXPECT_EQ(phase->mask(225, 200), 1);
  EXPECT_TRUE(std::isnan(phase->unwrapped.phase(75, 200)));
}

TEST(MeasurePhase, RefusesAPictureWithoutStripes) {
  std::mt19937 engine(3);
  std::normal_distribution<double> noise(0, 0.05);
  const auto blotches = FromLight(400, 300, [&](int col, int row) {
    return 0.4 + 0.2 * std::sin(col / 70.0) * std::cos(row / 55.0) + noise(engine);
  });
  const auto uniform = FromLight(400, 300, [](int, int) { return 0.5; });
  const auto white = FromLight(400, 300, [](int, int) { return 1.0; });
  for (const Photograph* photograph : {&blotches, &uniform, &white}) {
    const auto phase = MeasurePhase(*photograph);
    ASSERT_FALSE(phase);
    EXPECT_EQ(phase.error().code, ErrorCode::kNoCarrier);
    EXPECT_THAT(phase.error().message, ::testing::HasSubstr("check"));
  }
}

TEST(MeasurePhase, RefusesAThumbnail) {
  for (const int side : {1, 31}) {
    const auto phase = MeasurePhase(FromLight(side, side, [](int, int) { return 0.5; }));
    ASSERT_FALSE(phase);
    EXPECT_EQ(phase.error().code, ErrorCode::kBadImage);
  }
}

}  // namespace
}  // namespace striae::reconstruct
