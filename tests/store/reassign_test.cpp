// A photograph under the wrong subject is moved, and nothing about it is forgotten.
#include "store/reassign.h"

#include "store/locks.h"
#include "tests/store/signed_in.h"

namespace striae::testing {
namespace {

using store::Role;

class Reassigned : public ::testing::Test {
 protected:
  Status Move(const CaptureId& capture, const Session& to, const std::string& reason = "wrong patient") {
    return store::ReassignCaptures(study_.record(), std::array{capture}, to.id, reason, by_, NextStamp());
  }

  SmallStudy study_;
  Subject wrong_ = study_.EnrolWithConsent("S001"), right_ = study_.EnrolWithConsent("S002");
  Session from_ = study_.Open(wrong_), to_ = study_.Open(right_);
  Capture capture_ = study_.Import(from_, "photograph");
  store::SignedIn by_ = SignedInAs(study_, "cora", Role::kCoordinator);
};

TEST_F(Reassigned, ACaptureIsUnderTheRightSubjectAndItsOldPlaceInTheTrail) {
  ASSERT_THAT(Move(capture_.id, to_), IsOk());
  EXPECT_EQ(study_->CaptureById(capture_.id)->session, to_.id);
  EXPECT_TRUE(study_->Captures(from_.id)->empty());
  bool told = false;
  for (const store::AuditRow& row : std::vector(*study_->History(capture_.id.ToString()))) {
    if (row.field != "session_id") continue;
    told = true;
    EXPECT_EQ(row.old_value, "\"" + from_.id.ToString() + "\"");
    EXPECT_EQ(row.reason, "wrong patient");
    EXPECT_EQ(row.stamp.user, "cora");
  }
  EXPECT_TRUE(told);
  const auto shown = study_->Describe(capture_.id.ToString());
  EXPECT_EQ((*shown)["subject"], "S002");
  EXPECT_EQ((*shown)["reassignments"][0]["from"], from_.id.ToString());
  EXPECT_TRUE(study_->Check()->Passed());
}

TEST_F(Reassigned, NumbersAreStaleUntilTheyAreComputedAgain) {
  ASSERT_THAT(study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 4.0), NextStamp()), IsOk());
  EXPECT_FALSE(study_->Results()->front().stale);
  ASSERT_THAT(Move(capture_.id, to_), IsOk());
  EXPECT_TRUE(study_->Results()->front().stale);
  EXPECT_EQ(study_->Results()->front().subject.pseudonym, "S002");
  EXPECT_EQ(store::StaleCaptures(study_.record())->size(), 1U);
  ASSERT_THAT(study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 4.0), NextStamp()), IsOk());
  EXPECT_FALSE(study_->Results()->front().stale) << "the same number, computed for the new place";
  EXPECT_TRUE(store::StaleCaptures(study_.record())->empty());
}

TEST_F(Reassigned, APoseIsStaleWhenItsNeutralPoseLeaves) {
  const Capture neutral = study_.Import(from_, "neutral", "neutral");
  const Capture pose = study_.Import(from_, "pose", "pose");
  ASSERT_THAT(study_->AddReport(CountedId<ReportId>(), pose.id, WoundReport(pose, 4.0), NextStamp()), IsOk());
  ASSERT_THAT(Move(neutral.id, to_), IsOk());
  EXPECT_TRUE(study_->Results()->front().stale);
}

TEST_F(Reassigned, ASessionMovesWithAllItsCaptures) {
  ASSERT_THAT(study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 4.0), NextStamp()), IsOk());
  ASSERT_THAT(store::ReassignSession(study_.record(), from_.id, right_.id, "V3", CountedId<VisitId>(), "wrong patient",
                                     by_, NextStamp()),
              IsOk());
  const auto row = study_->Results()->front();
  EXPECT_EQ(row.subject.pseudonym, "S002");
  EXPECT_EQ(row.visit.name, "V3");
  EXPECT_TRUE(row.stale);
  EXPECT_TRUE(study_->Check()->Passed());
}

TEST_F(Reassigned, NeedsAReasonConsentAndTheRight) {
  EXPECT_THAT(Move(capture_.id, to_, ""), FailsWith(ErrorCode::kUsage, "needs a reason"));
  const Session without = study_.Open(study_.Enrol("S003"));
  EXPECT_THAT(Move(capture_.id, without), FailsWith(ErrorCode::kRecordRefused, "S003 has no active consent"));
  const auto monitor = SignedInAs(study_, "mona", Role::kMonitor);
  EXPECT_THAT(store::ReassignCaptures(study_.record(), std::array{capture_.id}, to_.id, "r", monitor, NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "may not reassign"));
  EXPECT_EQ(study_->CaptureById(capture_.id)->session, from_.id);
}

TEST_F(Reassigned, IsTheOnlyWayToMoveAPhotograph) {
  EXPECT_THAT(RawSql(study_.database(), "UPDATE capture SET session_id = '" + to_.id.ToString() + "'"),
              ::testing::HasSubstr("by a reassignment only"));
  EXPECT_THAT(RawSql(study_.database(), "UPDATE session SET subject_id = '" + right_.id.ToString() + "'"),
              ::testing::HasSubstr("by a reassignment only"));
}

TEST_F(Reassigned, ANeutralPoseOfSeveralSessionsMovesAsAWhole) {
  const Capture first = study_.Import(from_, "neutral", "neutral");
  const Capture second = study_.Import(study_.Open(wrong_, "V2"), "neutral", "neutral");
  EXPECT_THAT(Move(first.id, to_), FailsWith(ErrorCode::kRecordRefused, "under two subjects"));
  EXPECT_EQ(study_->CaptureById(first.id)->session, from_.id) << "nothing was moved";
  const Session other = study_.Open(right_, "V2");
  EXPECT_THAT(store::ReassignCaptures(study_.record(), std::array{first.id, second.id}, to_.id, "wrong patient", by_,
                                      NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "has the photograph"));
  EXPECT_EQ(study_->Captures(other.id)->size(), 0U);
}

TEST_F(Reassigned, ThereAndBackAgainIsTold) {
  ASSERT_THAT(Move(capture_.id, to_), IsOk());
  study_.Import(from_, "the one after");  // takes the number that became free
  ASSERT_THAT(Move(capture_.id, from_, "it was right"), IsOk());
  EXPECT_EQ(store::Reassignments(study_.record(), capture_.id.ToString())->size(), 2U);
  EXPECT_EQ(study_->Captures(from_.id)->size(), 2U);
  EXPECT_TRUE(study_->Check()->Passed());
}

TEST_F(Reassigned, BreaksTheSignaturesOfBothPlaces) {
  const auto investigator = SignedInAs(study_, "anna", Role::kInvestigator);
  for (const Session& session : {from_, to_}) {
    ASSERT_THAT(store::Sign(study_.record(), CountedId<store::SignatureId>(), {"session", session.id.ToString()},
                            store::Meaning::kReviewed, investigator, NextStamp()),
                IsOk());
  }
  ASSERT_THAT(Move(capture_.id, to_), IsOk());
  for (const store::Signature& signature : std::vector(*store::Signatures(study_.record()))) {
    EXPECT_EQ(signature.state, store::Signature::State::kBroken);
  }
}

TEST_F(Reassigned, TheSamePhotographUnderTwoSubjectsIsRefusedAndTheFirstPlaceNamed) {
  const auto again = study_->AddCapture(SmallStudy::Photograph(to_), Bytes("photograph"), NextStamp());
  EXPECT_THAT(again, FailsWith(ErrorCode::kRecordRefused, "subject S001, visit V1"));
}

}  // namespace
}  // namespace striae::testing
