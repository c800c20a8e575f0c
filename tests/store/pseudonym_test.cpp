// Check digits, against the examples that their sources print.
#include "store/pseudonym.h"

#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

using store::CheckDigitOf;
using store::CheckPattern;
using store::CheckPseudonym;

TEST(CheckDigit, IsThatOfThePublishedExamples) {
  EXPECT_EQ(*CheckDigitOf("0794", "iso7064"), '5');     // ISO 7064 MOD 11,10: 07945
  EXPECT_EQ(*CheckDigitOf("7992739871", "luhn"), '3');  // the usual example, 79927398713
  EXPECT_EQ(*CheckDigitOf("236", "verhoeff"), '3');     // Verhoeff: 2363
}

TEST(CheckDigit, FindsEveryWrongDigit) {
  for (const char* method : {"iso7064", "luhn", "verhoeff"}) {
    for (int number = 0; number < 1000; number += 7) {
      std::string digits = std::to_string(1000 + number).substr(1);
      const char right = *CheckDigitOf(digits, method);
      for (char& digit : digits) {
        const char before = digit;
        for (digit = '0'; digit <= '9'; ++digit) {
          if (digit == before) continue;
          EXPECT_NE(*CheckDigitOf(digits, method), right) << method << " " << digits;
        }
        digit = before;
      }
    }
  }
}

TEST(CheckDigit, OfVerhoeffFindsEveryExchangeOfNeighbours) {
  for (int number = 0; number < 1000; ++number) {
    const std::string digits = std::to_string(1000 + number).substr(1);
    std::string exchanged = digits;
    std::swap(exchanged[1], exchanged[2]);
    if (exchanged == digits) continue;
    EXPECT_NE(*CheckDigitOf(exchanged, "verhoeff"), *CheckDigitOf(digits, "verhoeff"));
  }
}

TEST(Pseudonym, OfAStudyWithAPatternMustFitIt) {
  EXPECT_THAT(CheckPseudonym("S0016", "S###C", "iso7064"), IsOk());
  EXPECT_THAT(CheckPseudonym("T0016", "S###C", "iso7064"), FailsWith(ErrorCode::kUsage, "does not fit"));
  EXPECT_THAT(CheckPseudonym("S00166", "S###C", "iso7064"), FailsWith(ErrorCode::kUsage, "does not fit"));
  EXPECT_THAT(CheckPseudonym("LJ-A07", "LJ-?##", ""), IsOk());
  EXPECT_THAT(CheckPseudonym("LJ-a07", "LJ-?##", ""), FailsWith(ErrorCode::kUsage, "does not fit"));
  EXPECT_THAT(CheckPseudonym("anything", "", ""), IsOk());
}

TEST(Pseudonym, LearnsItsCheckDigitOnlyWhereNoneWasTyped) {
  EXPECT_THAT(CheckPseudonym("S001", "S###C", "iso7064"), FailsWith(ErrorCode::kUsage, "it is S0016"));
  const Status wrong = CheckPseudonym("S0017", "S###C", "iso7064");
  EXPECT_THAT(wrong, FailsWith(ErrorCode::kUsage, "check digit of S0017 is wrong"));
  EXPECT_EQ(wrong.error().message.find("S0016"), std::string::npos)
      << "the wrong sign may be another: naming the digit would enrol the wrong subject";
}

TEST(Pseudonym, PatternsThatCannotBeMeantAreRefused) {
  EXPECT_THAT(CheckPattern("S###C", "iso7064"), IsOk());
  EXPECT_THAT(CheckPattern("S###", "iso7064"), FailsWith(ErrorCode::kUsage, "C at its end"));
  EXPECT_THAT(CheckPattern("S###C", "crc32"), FailsWith(ErrorCode::kUsage, "iso7064, luhn or verhoeff"));
  EXPECT_THAT(CheckPattern("S 001", ""), FailsWith(ErrorCode::kUsage, "--subject-pattern"));
  EXPECT_THAT(CheckPattern("SUBJECT", ""), FailsWith(ErrorCode::kUsage, "at least one # or ?"));
}

}  // namespace
}  // namespace striae::testing
