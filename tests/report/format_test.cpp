// A reader is given as many digits as the uncertainty supports.
#include "report/format.h"

#include <gtest/gtest.h>

#include "report/quantity.h"

namespace striae::report {
namespace {

TEST(Format, GivesTheUncertaintyTwoSignificantDigits) {
  EXPECT_EQ(FormatWithUncertainty(0.71342, 0.0521), "0.713 ± 0.052");
  EXPECT_EQ(FormatWithUncertainty(12.0, 0.3), "12.00 ± 0.30");
  EXPECT_EQ(FormatWithUncertainty(131.24, 2.14), "131.2 ± 2.1");
  EXPECT_EQ(FormatWithUncertainty(1234.4, 12.3), "1234 ± 12");
  EXPECT_EQ(FormatWithUncertainty(1234.0, 123.0), "1230 ± 120");
}

TEST(Format, KeepsTwoDigitsWhenRoundingUpAddsOne) {
  EXPECT_EQ(FormatWithUncertainty(1.0, 0.0996), "1.00 ± 0.10");
  EXPECT_EQ(FormatWithUncertainty(50.0, 9.96), "50 ± 10");
  EXPECT_EQ(FormatWithUncertainty(50.0, 9.94), "50.0 ± 9.9");
}

TEST(Format, WritesATrueMinusAndNeverMinusZero) {
  EXPECT_EQ(FormatWithUncertainty(-8.04, 1.5), "\u22128.0 ± 1.5");
  EXPECT_EQ(FormatNumber(-0.004, 2), "0.00");
  EXPECT_EQ(FormatSigned(0.004, 2), "0.00");
  EXPECT_EQ(FormatSigned(1.5, 2), "+1.50");
  EXPECT_EQ(FormatPercent(-37.4), "\u221237\u00a0%");
}

TEST(Format, SaysThatAnUncertaintyIsNotKnown) {
  EXPECT_EQ(FormatWithUncertainty(0.71342, 0), "0.713 (uncertainty not known)");
}

TEST(Format, PrintsUnitsAsTheyAreWritten) {
  EXPECT_EQ(UnitText("cm2"), "cm²");
  EXPECT_EQ(UnitText("mL"), "mL");
  EXPECT_EQ(UnitText("N/m"), "N/m");
}

TEST(AngleInWords, NamesTheSubjectsSide) {
  EXPECT_EQ(InWords("rotation", 32.2, 1.5), "turned 32 deg to the subject's left");
  EXPECT_EQ(InWords("rotation", -32.2, 1.5), "turned 32 deg to the subject's right");
  EXPECT_EQ(InWords("tilt", 8, 1), "tilted 8 deg to the subject's right");
  EXPECT_EQ(InWords("tilt", -8, 1), "tilted 8 deg to the subject's left");
  EXPECT_EQ(InWords("flexion", 12, 1), "bent 12 deg forward, chin towards chest");
  EXPECT_EQ(InWords("flexion", -12, 1), "bent 12 deg back, chin away from chest");
}

TEST(AngleInWords, ClaimsNoSideWithinError) {
  EXPECT_EQ(InWords("rotation", 2.9, 1.5), "straight within error");  // 1.96 x 1.5 = 2.94
  EXPECT_EQ(InWords("rotation", 3.0, 1.5), "turned 3 deg to the subject's left");
  EXPECT_EQ(InWords("volume", 3.0, 1.5), "");
}

}  // namespace
}  // namespace striae::report
