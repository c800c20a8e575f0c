// Changes are judged against the readings' own error. Every limit here is worked out by hand.
#include "report/verdict.h"

#include <cmath>

#include <gtest/gtest.h>

namespace striae::report {
namespace {

Reading Of(double value, double uncertainty, const char* unit = "mL") {
  return {value, uncertainty, unit, false, "wound 1"};
}

TEST(Verdict, HasTheLimitOfMdc95WithBothUncertainties) {
  const Comparison c = Compare(Of(4.0, 0.3), Of(3.0, 0.4), Better::kSmaller);
  EXPECT_DOUBLE_EQ(c.change_uncertainty, 0.5);  // 3-4-5
  EXPECT_DOUBLE_EQ(c.limit, 0.98);              // 1.96 x 0.5
  EXPECT_DOUBLE_EQ(*c.change, -1.0);
  EXPECT_DOUBLE_EQ(*c.percent, -25.0);
  // Equal uncertainties are SEM: MDC95 = 1.96 sqrt(2) SEM.
  EXPECT_NEAR(Compare(Of(4, 0.2), Of(4, 0.2), Better::kSmaller).limit, 0.554372, 1e-6);
}

TEST(Verdict, TurnsAtTheLimit) {
  const auto verdict = [](double now) { return Compare(Of(4.0, 0.3), Of(now, 0.4), Better::kSmaller).verdict; };
  EXPECT_EQ(verdict(3.03), Verdict::kWithinError);
  EXPECT_EQ(verdict(3.01), Verdict::kImproved);
  EXPECT_EQ(verdict(4.97), Verdict::kWithinError);
  EXPECT_EQ(verdict(4.99), Verdict::kWorse);
}

TEST(Verdict, FollowsTheBetterDirection) {
  EXPECT_EQ(Compare(Of(4, 0.1), Of(6, 0.1), Better::kLarger).verdict, Verdict::kImproved);
  EXPECT_EQ(Compare(Of(4, 0.1), Of(2, 0.1), Better::kLarger).verdict, Verdict::kWorse);
  const Comparison none = Compare(Of(4, 0.1), Of(2, 0.1), Better::kNotDefined);
  EXPECT_EQ(none.verdict, Verdict::kNotAssessable);
  EXPECT_EQ(none.reason, "no better direction defined");
  EXPECT_DOUBLE_EQ(*none.change, -2);
}

TEST(Verdict, ComparesTheSizeOfAnglesNotTheirSign) {
  const auto angle = [](double before, double after) {
    return Compare(Of(before, 1.5, "deg"), Of(after, 1.5, "deg"), Better::kSmallerSize);  // limit 4.16
  };
  EXPECT_EQ(angle(-40, -32).verdict, Verdict::kImproved);
  EXPECT_DOUBLE_EQ(*angle(-40, -32).change, -8);
  EXPECT_DOUBLE_EQ(*angle(-40, -32).percent, -20);
  EXPECT_EQ(angle(-8, -14).verdict, Verdict::kWorse);
  EXPECT_EQ(angle(20, -5).verdict, Verdict::kImproved);
  EXPECT_EQ(angle(1, -1).verdict, Verdict::kWithinError);
  const Comparison other_side = angle(10, -10);  // plainly moved, but neither nearer nor farther
  EXPECT_EQ(other_side.verdict, Verdict::kNotAssessable);
  EXPECT_EQ(other_side.reason, "now to the other side");
}

TEST(Verdict, IsNotAssessableWithoutTwoSoundReadings) {
  Reading flagged = Of(4, 0.1);
  flagged.flagged = true;
  Reading other_method = Of(4, 0.1);
  other_method.method = "wound 2";
  const auto reason = [](const Reading& first, const Reading& now) {
    const Comparison c = Compare(first, now, Better::kSmaller);
    EXPECT_EQ(c.verdict, Verdict::kNotAssessable);
    return c.reason;
  };
  EXPECT_EQ(reason(flagged, Of(1, 0.1)), "first flagged");
  EXPECT_EQ(reason(Of(1, 0.1), flagged), "flagged");
  EXPECT_EQ(reason(flagged, flagged), "flagged");
  EXPECT_EQ(reason(Of(1, 0.1), Of(4, 0)), "uncertainty not known");
  EXPECT_EQ(reason(other_method, Of(1, 0.1)), "different methods: wound 2, wound 1");
  EXPECT_EQ(reason(Of(1, 0.1, "mL"), Of(1, 0.1, "cm2")), "different units: mL, cm2");
  EXPECT_FALSE(Compare(Of(1, 0.1, "mL"), Of(1, 0.1, "cm2"), Better::kSmaller).change.has_value());
}

TEST(Verdict, GivesNoPercentOfAlmostNothing) {
  EXPECT_FALSE(Compare(Of(0.1, 0.1), Of(3, 0.1), Better::kSmaller).percent.has_value());
  EXPECT_FALSE(Compare(Of(0, 0), Of(3, 0.1), Better::kSmaller).percent.has_value());
}

}  // namespace
}  // namespace striae::report
