// Pseudonyms and consent.
#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

const Date kMay1{2026, 5, 1}, kMay8{2026, 5, 8}, kMay15{2026, 5, 15};

TEST(Subjects, AreFoundByPseudonymAndListedInOrder) {
  SmallStudy study;
  study.Enrol("S002");
  const Subject first = study.Enrol("S001");
  study.Reopen();
  EXPECT_EQ(study->SubjectByPseudonym("S001")->id, first.id);
  EXPECT_EQ(study->SubjectById(first.id)->site, study.site());
  const auto all = study->Subjects();
  ASSERT_EQ(all->size(), 2U);
  EXPECT_EQ(all->front().pseudonym, "S001");
  EXPECT_THAT(study->SubjectByPseudonym("S009"), FailsWith(ErrorCode::kNotFound, "striae subject add"));
}

TEST(Subjects, HaveAPseudonymThatIsNoName) {
  SmallStudy study;
  for (const char* bad : {"", "Test Subject", "Test^Subject", "S/1", "../S1", "S001\n", "\xC5\xA0 1",
                          "a-pseudonym-that-is-longer-than-32-signs"}) {
    EXPECT_THAT(study->AddSubject({CountedId<SubjectId>(), bad, study.site(), {}, {}}, NextStamp()),
                FailsWith(ErrorCode::kUsage, "no pseudonym"))
        << bad;
  }
}

TEST(Subjects, AreUniqueWhateverTheCaseOfTheLetters) {
  SmallStudy study;
  study.Enrol("S001");
  for (const char* again : {"S001", "s001"}) {
    EXPECT_THAT(study->AddSubject({CountedId<SubjectId>(), again, study.site(), {}, {}}, NextStamp()),
                FailsWith(ErrorCode::kRecordRefused, "already"));
  }
  EXPECT_THAT(study->AddSubject({CountedId<SubjectId>(), "S002", CountedId<SiteId>(), {}, {}}, NextStamp()),
              FailsWith(ErrorCode::kNotFound, "no site"));
  EXPECT_EQ(study->Subjects()->size(), 1U);
}

TEST(Consent, IsGivenWithdrawnAndGivenAgain) {
  SmallStudy study;
  const SubjectId id = study.Enrol("S001").id;
  EXPECT_FALSE(study->SubjectById(id)->HasActiveConsent());
  ASSERT_THAT(study->GiveConsent(id, kMay1, NextStamp()), IsOk());
  EXPECT_TRUE(study->SubjectById(id)->HasActiveConsent());
  ASSERT_THAT(study->WithdrawConsent(id, kMay8, "", NextStamp()), IsOk());
  study.Reopen();
  EXPECT_EQ(study->SubjectById(id)->consent_given, kMay1);
  EXPECT_EQ(study->SubjectById(id)->consent_withdrawn, kMay8);
  ASSERT_THAT(study->GiveConsent(id, kMay15, NextStamp()), IsOk());
  EXPECT_EQ(study->SubjectById(id)->consent_given, kMay15);
  EXPECT_TRUE(study->SubjectById(id)->HasActiveConsent());
  EXPECT_EQ(study->History("S001")->size(), 4U) << "enrolment and three entries about consent";
}

TEST(Consent, TheSameEntryTwiceChangesNothing) {
  SmallStudy study;
  const SubjectId id = study.Enrol("S001").id;
  ASSERT_THAT(study->GiveConsent(id, kMay1, NextStamp()), IsOk());
  const auto head = study->Head()->sequence;
  EXPECT_THAT(study->GiveConsent(id, kMay1, NextStamp()), IsOk());
  EXPECT_EQ(study->Head()->sequence, head);
}

TEST(Consent, FollowsTheOrderOfDays) {
  SmallStudy study;
  const SubjectId id = study.Enrol("S001").id;
  EXPECT_THAT(study->WithdrawConsent(id, kMay8, "", NextStamp()), FailsWith(ErrorCode::kRecordRefused, "no consent"));
  ASSERT_THAT(study->GiveConsent(id, kMay8, NextStamp()), IsOk());
  EXPECT_THAT(study->GiveConsent(id, kMay15, NextStamp()), FailsWith(ErrorCode::kRecordRefused, "active since"));
  EXPECT_THAT(study->WithdrawConsent(id, kMay1, "", NextStamp()), FailsWith(ErrorCode::kRecordRefused, "before"));
  ASSERT_THAT(study->WithdrawConsent(id, kMay15, "moved away", NextStamp()), IsOk());
  EXPECT_THAT(study->GiveConsent(id, kMay8, NextStamp()), FailsWith(ErrorCode::kRecordRefused, "that day or later"));
  EXPECT_THAT(study->GiveConsent(CountedId<SubjectId>(), kMay8, NextStamp()),
              FailsWith(ErrorCode::kNotFound, "no subject"));
}

}  // namespace
}  // namespace striae::testing
