#include "core/id.h"

#include <type_traits>

#include <gmock/gmock.h>

#include "core/hex.h"

namespace striae {
namespace {

TEST(Id, PrintsAndParsesTheCanonicalForm) {
  const auto id = SessionId::Parse("0F8fad5b-d9cb-469f-a165-70867728950e");
  ASSERT_TRUE(id);
  EXPECT_EQ(id->ToString(), "0f8fad5b-d9cb-469f-a165-70867728950e");
}

TEST(Id, FromRandomBytesIsVersionFour) {
  std::array<std::uint8_t, 16> random;
  random.fill(0xff);
  EXPECT_EQ(Uuid::FromRandom(random).ToString(), "ffffffff-ffff-4fff-bfff-ffffffffffff");
}

TEST(Id, RefusesEverythingElse) {
  for (const char* text : {"", "S001", "0f8fad5bd9cb469fa16570867728950e0000", "0f8fad5b-d9cb-469f-a165-70867728950",
                           "0f8fad5b-d9cb-469f-a165-7086772895zz", "-f8fad5b-d9cb-469f-a165-70867728950e"}) {
    EXPECT_FALSE(SessionId::Parse(text)) << text;
  }
}

TEST(Id, KindsDoNotMix) {
  static_assert(!std::is_convertible_v<SubjectId, SessionId>);
  static_assert(!std::is_constructible_v<SessionId, SubjectId>);
}

TEST(Sha256, NeedsSixtyFourDigits) {
  const std::string digits(64, 'a');
  ASSERT_TRUE(Sha256::Parse(digits));
  EXPECT_EQ(Sha256::Parse(digits)->ToString(), digits);
  EXPECT_FALSE(Sha256::Parse(digits.substr(1)));
  EXPECT_FALSE(Sha256::Parse(digits.substr(1) + "g"));
}

}  // namespace
}  // namespace striae
