#include "core/study.h"

#include <gmock/gmock.h>

namespace striae {
namespace {

TEST(CaptureRole, ReadsWhatItPrints) {
  for (const char* text : {"wound:W1", "wound:left heel", "neutral", "pose", "unassigned"}) {
    const auto role = CaptureRole::Parse(text);
    ASSERT_TRUE(role) << text;
    EXPECT_EQ(role->ToString(), text);
  }
  for (const char* text : {"", "wound", "wound:", "Neutral", "posed"}) {
    const auto role = CaptureRole::Parse(text);
    ASSERT_FALSE(role) << text;
    EXPECT_EQ(role.error().code, ErrorCode::kUsage);
  }
}

TEST(Consent, IsActiveFromGivenUntilWithdrawn) {
  Subject subject;
  EXPECT_FALSE(subject.HasActiveConsent());
  subject.consent_given = Date{2026, 5, 4};
  EXPECT_TRUE(subject.HasActiveConsent());
  subject.consent_withdrawn = Date{2026, 6, 1};
  EXPECT_FALSE(subject.HasActiveConsent());
}

TEST(Laterality, HasDicomsLetters) {
  for (const char* text : {"", "L", "R", "B", "U"}) EXPECT_EQ(ToString(*ParseLaterality(text)), text);
  EXPECT_FALSE(ParseLaterality("left"));
}

}  // namespace
}  // namespace striae
