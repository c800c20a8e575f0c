// A lock is kept by the database itself; a signature stands for one content.
#include "store/locks.h"

#include "store/annotations.h"
#include "tests/store/signed_in.h"

namespace striae::testing {
namespace {

using store::Meaning;
using store::Record;
using store::Role;
using State = store::Signature::State;

class Locked : public ::testing::Test {
 protected:
  [[nodiscard]] Record::Found Session() const { return {"session", capture_.session.ToString()}; }
  Status Lock(const Record::Found& target) {
    return store::AddLock(study_.record(), CountedId<store::LockId>(), target, "data are clean", by_, NextStamp());
  }
  State StateOf(const Record::Found& target) { return store::Signatures(study_.record(), target.id)->back().state; }
  Status Sign(const Record::Found& target) {
    const auto done =
        store::Sign(study_.record(), CountedId<store::SignatureId>(), target, Meaning::kApproved, by_, NextStamp());
    return done ? Status{} : Status(Fail(done.error()));
  }

  SmallStudy study_;
  Subject subject_ = study_.EnrolWithConsent("S001");
  Capture capture_ = study_.Import(study_.Open(subject_), "photograph");
  store::SignedIn by_ = SignedInAs(study_, "anna", Role::kInvestigator);
};

TEST_F(Locked, NothingBelowItChangesInAnyProgram) {
  ASSERT_THAT(Lock({"subject", subject_.id.ToString()}), IsOk());
  EXPECT_THAT(
      study_->AddCapture(SmallStudy::Photograph(*study_->SessionById(capture_.session)), Bytes("another"), NextStamp()),
      FailsWith(ErrorCode::kRecordRefused, "is locked"));
  EXPECT_THAT(study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 4.0), NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "locked"));
  EXPECT_THAT(study_->SetRole(capture_.id, *CaptureRole::Parse("pose"), "why not", NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "locked"));
  EXPECT_THAT(study_->CloseSession(capture_.session, NextStamp()), FailsWith(ErrorCode::kRecordRefused, "locked"));
  EXPECT_THAT(store::Exclude(study_.record(), CountedId<store::ExclusionId>(), {"capture", capture_.id.ToString()},
                             "late", NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "locked"));
  EXPECT_THAT(RawSql(study_.database(), "UPDATE capture SET role = 'pose'"), ::testing::HasSubstr("locked"));
  EXPECT_THAT(RawSql(study_.database(), "UPDATE session SET closed_at = '2026'"), ::testing::HasSubstr("locked"));
  EXPECT_THAT(RawSql(study_.database(), "DELETE FROM lock"), ::testing::HasSubstr("never deleted"));
  EXPECT_TRUE(study_->Check()->Passed());
}

TEST_F(Locked, OthersGoOn) {
  ASSERT_THAT(Lock({"subject", subject_.id.ToString()}), IsOk());
  study_.Import(study_.Open(study_.EnrolWithConsent("S002")), "another photograph");
  EXPECT_THAT(Lock({"subject", subject_.id.ToString()}), FailsWith(ErrorCode::kRecordRefused, "locked already"));
}

TEST_F(Locked, ConsentNotesAndQueriesStayPossible) {
  ASSERT_THAT(Lock({"subject", subject_.id.ToString()}), IsOk());
  EXPECT_THAT(study_->WithdrawConsent(subject_.id, {2026, 5, 20}, "", NextStamp()), IsOk());
  EXPECT_THAT(store::OpenQuery(study_.record(), CountedId<store::QueryId>(), Session(), "why?", NextStamp()), IsOk());
}

TEST_F(Locked, AStudyTakesNoSubjectAnyMore) {
  ASSERT_THAT(Lock({"study", study_->GetStudy()->id.ToString()}), IsOk());
  EXPECT_THAT(study_->AddSubject({CountedId<SubjectId>(), "S009", study_.site(), {}, {}}, NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "the study is locked"));
  EXPECT_THAT(study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 4.0), NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "locked"));
}

TEST_F(Locked, EndsWithAReasonByARoleThatMayAndVoidsSignatures) {
  ASSERT_THAT(Sign(Session()), IsOk());
  ASSERT_THAT(Lock({"subject", subject_.id.ToString()}), IsOk());
  EXPECT_EQ(StateOf(Session()), State::kValid) << "a lock changes nothing that was signed";
  const store::LockId lock = store::Locks(study_.record())->front().id;
  const auto monitor = SignedInAs(study_, "mona", Role::kMonitor);
  EXPECT_THAT(store::Unlock(study_.record(), CountedId<store::UnlockId>(), lock, "let me", monitor, NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "may not unlock"));
  EXPECT_THAT(store::Unlock(study_.record(), CountedId<store::UnlockId>(), lock, "", by_, NextStamp()),
              FailsWith(ErrorCode::kUsage, "needs a reason"));
  ASSERT_THAT(store::Unlock(study_.record(), CountedId<store::UnlockId>(), lock, "wrong date", by_, NextStamp()),
              IsOk());
  EXPECT_EQ(StateOf(Session()), State::kVoided);
  const auto told = [&](const std::string& of, const char* what) {
    const auto rows = *study_->History(of);
    return std::count_if(rows.begin(), rows.end(), [&](const store::AuditRow& row) { return row.entity == what; });
  };
  EXPECT_EQ(told(subject_.id.ToString(), "unlock"), 1) << "the history of what was locked tells of its end";
  EXPECT_EQ(told(Session().id, "void_signature"), 1);
  EXPECT_THAT(study_->CloseSession(capture_.session, NextStamp()), IsOk());
  EXPECT_EQ(study_->History(lock.ToString())->back().stamp.user, "anna") << "who signed in, not who owns the machine";
  EXPECT_TRUE(study_->Check()->Passed());
}

TEST_F(Locked, ASignatureBreaksWhenWhatWasSignedChanges) {
  ASSERT_THAT(Sign(Session()), IsOk());
  EXPECT_EQ(StateOf(Session()), State::kValid);
  ASSERT_THAT(store::AddNote(study_.record(), {CountedId<store::NoteId>(), Session(), false, {2026, 5, 4}, "fine"}, "",
                             NextStamp()),
              IsOk());
  EXPECT_EQ(StateOf(Session()), State::kValid) << "a note about it is not part of it";
  ASSERT_THAT(study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 4.0), NextStamp()), IsOk());
  EXPECT_EQ(StateOf(Session()), State::kBroken);
  ASSERT_THAT(Sign(Session()), IsOk());
  EXPECT_EQ(StateOf(Session()), State::kValid);
  EXPECT_EQ((*study_->Describe(Session().id))["signatures"].size(), 2U);
}

TEST_F(Locked, SignaturesAreForRolesThatMayAndThingsThatHaveContent) {
  const auto coordinator = SignedInAs(study_, "cora", Role::kCoordinator);
  EXPECT_THAT(store::Sign(study_.record(), CountedId<store::SignatureId>(), Session(), Meaning::kReviewed, coordinator,
                          NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "may not sign"));
  EXPECT_THAT(Sign({"site", study_.site().ToString()}), FailsWith(ErrorCode::kUsage, "not a site"));
  EXPECT_THAT(Lock({"capture", capture_.id.ToString()}), FailsWith(ErrorCode::kUsage, "not a capture"));
}

}  // namespace
}  // namespace striae::testing
