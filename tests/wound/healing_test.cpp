// Healing over visits: closed forms of circles and exponentials, and what must not be predicted.
#include "analysis/wound/healing.h"

#include <cmath>

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

namespace striae::wound {
namespace {

using ::testing::HasSubstr;

HealingPoint Circle(double day, double radius_mm, double relative_sd = 0.02) {
  const double area = M_PI * radius_mm * radius_mm / 100;
  return {day, area, relative_sd * area, 2 * M_PI * radius_mm, relative_sd * M_PI * radius_mm};
}

RC_GTEST_PROP(LinearHealing, OfCirclesIsTheDifferenceOfTheirRadii, ()) {
  const double r1 = *rc::gen::inRange(1, 400) / 10.0, r2 = *rc::gen::inRange(1, 400) / 10.0;
  const Estimate d = LinearHealingMm(Circle(0, r1), Circle(7, r2));
  RC_ASSERT(std::abs(d.value - (r1 - r2)) < 1e-9);
  RC_ASSERT(d.uncertainty > 0);
}

TEST(PercentAreaReduction, IsTheShareThatClosed) {
  // Half the radius is a quarter of the area; u: 0.25 * sqrt(2) * 2 % = 0.71 points.
  const Estimate par = PercentAreaReduction(Circle(0, 20), Circle(28, 10));
  EXPECT_NEAR(par.value, 75, 1e-9);
  EXPECT_NEAR(par.uncertainty, 0.707, 0.001);
  EXPECT_LT(PercentAreaReduction(Circle(0, 10), Circle(28, 20)).value, 0);  // it grew
}

TEST(Exponential, FindsTheRateOfAnExponential) {
  std::vector<HealingPoint> points;
  for (const double day : {0.0, 7.0, 14.0, 28.0}) points.push_back(Circle(day, 15 * std::exp(-0.02 * day)));
  const auto fit = FitExponential(points);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->rate_per_day.value, 0.04, 1e-9);  // the area falls twice as fast as the radius
  EXPECT_NEAR(fit->r_squared, 1, 1e-9);
  EXPECT_NEAR(fit->area0_cm2, M_PI * 2.25, 1e-9);
  ASSERT_TRUE(fit->half_life_day);
  EXPECT_NEAR(*fit->half_life_day, std::log(2) / 0.04, 1e-6);
}

TEST(Exponential, OfAStandingWoundHasNoHalfLife) {
  const auto fit = FitExponential(std::vector{Circle(0, 10), Circle(7, 10.1), Circle(14, 9.98)});
  ASSERT_TRUE(fit);
  EXPECT_FALSE(fit->half_life_day);
  EXPECT_LT(fit->r_squared, 0.9);
}

TEST(Exponential, WidensItsUncertaintyWithTheScatter) {
  // The same mean decline; areas that claim 0.1 % but scatter by 10 %.
  std::vector<HealingPoint> claimed;
  const double off[] = {1.05, 0.95, 1.05, 0.95, 1.05};
  for (int k = 0; k < 5; ++k) claimed.push_back(Circle(7 * k, 10 * off[k] * std::exp(-0.01 * 7 * k), 0.001));
  const auto fit = FitExponential(claimed);
  ASSERT_TRUE(fit);
  // Scatter of ln A: 0.1 over sqrt(sum (t - mean)^2) = 22.1 days gives about 0.005.
  EXPECT_GT(fit->rate_per_day.uncertainty, 0.003);
}

TEST(Exponential, IsRefusedForTwoAreasAndForAClosedWound) {
  EXPECT_FALSE(FitExponential(std::vector{Circle(0, 10), Circle(7, 8)}));
  const auto closed = FitExponential(std::vector{Circle(0, 10), Circle(7, 8), Circle(14, 0)});
  ASSERT_FALSE(closed);
  EXPECT_THAT(closed.error().message, HasSubstr("above zero"));
}

std::vector<HealingPoint> Advancing(int visits, double mm_per_week, double radius_mm) {
  std::vector<HealingPoint> points;
  for (int k = 0; k < visits; ++k) points.push_back(Circle(7 * k, radius_mm - mm_per_week * k));
  return points;
}

TEST(Closure, IsWhenTheEdgeReachesTheMiddle) {
  const auto closure = PredictClosure(Advancing(5, 2, 15));
  ASSERT_TRUE(closure) << closure.error().message;
  EXPECT_NEAR(closure->day, 7 * 7.5, 1e-6);
  EXPECT_NEAR(closure->advance_mm_per_day.value, 2.0 / 7, 1e-9);
  EXPECT_GT(closure->uncertainty_day, 0.2);  // radii to 1 % over four weeks
  EXPECT_LT(closure->uncertainty_day, 3);
}

TEST(Closure, IsRefusedBelowFiveAreas) {
  const auto closure = PredictClosure(Advancing(4, 2, 15));
  ASSERT_FALSE(closure);
  EXPECT_EQ(closure.error().code, ErrorCode::kMeasurementRefused);
  EXPECT_THAT(closure.error().message, HasSubstr("five"));
}

TEST(Closure, IsRefusedForAStandingWoundAndForADistantDay) {
  const auto standing = PredictClosure(Advancing(6, 0.001, 15));
  ASSERT_FALSE(standing);
  EXPECT_THAT(standing.error().message, HasSubstr("does not advance"));
  const auto distant = PredictClosure(Advancing(6, 0.5, 15));
  ASSERT_FALSE(distant);
  EXPECT_THAT(distant.error().message, HasSubstr("further ahead"));
}

TEST(Healing, RefusesDaysThatDoNotAscend) {
  auto points = Advancing(5, 2, 15);
  std::swap(points[1], points[2]);
  const auto closure = PredictClosure(points);
  ASSERT_FALSE(closure);
  EXPECT_EQ(closure.error().code, ErrorCode::kUsage);
}

TEST(Repeatability, OfPairsIsTheirDifferenceOverRootTwo) {
  // Differences of 2 in each of six pairs: SD_diff (about zero) = 2, SEM = sqrt 2, MDC95 = 1.96 * 2.
  const auto found = RepeatabilityOf({{1, 3}, {5, 7}, {9, 11}, {2, 4}, {6, 8}, {1, 3}, {4}});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->degrees_of_freedom, 6);
  EXPECT_NEAR(found->sem, std::sqrt(2), 1e-12);
  EXPECT_NEAR(found->mdc95, 3.92, 1e-9);
  EXPECT_FALSE(RepeatabilityOf({{1, 3}, {5, 7}}));  // two degrees of freedom are too few
}

}  // namespace
}  // namespace striae::wound
