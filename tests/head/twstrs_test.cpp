#include "analysis/head/twstrs.h"

#include <gtest/gtest.h>

namespace striae::head {
namespace {

int Score(const std::string& name, double degrees) { return TwstrsBand(name, degrees)->score; }

TEST(TwstrsBands, RotationHasTheScalesLimitsOnEitherSide) {
  for (const double side : {-1.0, 1.0}) {
    EXPECT_EQ(Score("rotation", side * 0.4), 0);
    EXPECT_EQ(Score("rotation", side * 1), 1);
    EXPECT_EQ(Score("rotation", side * 22.4), 1);
    EXPECT_EQ(Score("rotation", side * 22.6), 2);
    EXPECT_EQ(Score("rotation", side * 45), 2);
    EXPECT_EQ(Score("rotation", side * 46), 3);
    EXPECT_EQ(Score("rotation", side * 67), 3);
    EXPECT_EQ(Score("rotation", side * 68), 4);
  }
  EXPECT_FALSE(TwstrsBand("rotation", 91));
}

TEST(TwstrsBands, TiltIsLaterocollis) {
  EXPECT_EQ(Score("tilt", 0), 0);
  EXPECT_EQ(Score("tilt", -15), 1);
  EXPECT_EQ(Score("tilt", 16), 2);
  EXPECT_EQ(Score("tilt", 35), 2);
  EXPECT_EQ(Score("tilt", 36), 3);
  EXPECT_EQ(TwstrsBand("tilt", 20)->words, "moderate (16 to 35 deg), measured");
}

TEST(TwstrsBands, AnteroAndRetrocollisAreNotScored) {
  EXPECT_FALSE(TwstrsBand("flexion", 20));
  EXPECT_FALSE(TwstrsBand("total_angle", 20));
}

}  // namespace
}  // namespace striae::head
