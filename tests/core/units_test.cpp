#include "core/units.h"

#include <numbers>
#include <type_traits>

#include <gmock/gmock.h>

namespace striae {
namespace {

TEST(Units, ConvertAsTheirDefinitionsSay) {
  EXPECT_DOUBLE_EQ(Length::Metres(1.5).mm(), 1500);
  EXPECT_DOUBLE_EQ(Area::SquareMillimetres(250).cm2(), 2.5);
  EXPECT_DOUBLE_EQ(Volume::CubicMillimetres(8302).millilitres(), 8.302);
  EXPECT_DOUBLE_EQ(Angle::Degrees(180).rad(), std::numbers::pi);
  EXPECT_DOUBLE_EQ(Angle::Radians(std::numbers::pi / 6).deg(), 30);
}

TEST(Units, AddAndCompareWithinAQuantityOnly) {
  EXPECT_DOUBLE_EQ(Length(Length::Millimetres(2) + Length::Metres(1)).mm(), 1002);
  EXPECT_LT(Length::Millimetres(2), Length::Metres(1));
  static_assert(!std::is_convertible_v<Length, Area>);
  static_assert(!std::is_convertible_v<double, Length>);
}

}  // namespace
}  // namespace striae
