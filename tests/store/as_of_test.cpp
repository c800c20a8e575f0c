// The study as it stood at any time, rebuilt from its trail.
#include "store/as_of.h"

#include "store/annotations.h"
#include "store/reassign.h"
#include "tests/store/signed_in.h"

namespace striae::testing {
namespace {

TEST(AsOf, ShowsWhatWasKnownThenAndNothingOfLater) {
  SmallStudy study;
  const Subject subject = study.EnrolWithConsent("S001");
  const Capture capture = study.Import(study.Open(subject), "photograph");
  ASSERT_THAT(study->AddReport(CountedId<ReportId>(), capture.id, WoundReport(capture, 4.0), NextStamp()), IsOk());
  const UtcTime then = NextStamp().now;
  ASSERT_THAT(study->AddReport(CountedId<ReportId>(), capture.id, WoundReport(capture, 5.0), NextStamp()), IsOk());
  ASSERT_THAT(store::Exclude(study.record(), CountedId<store::ExclusionId>(), {"capture", capture.id.ToString()},
                             "moved", NextStamp()),
              IsOk());
  ASSERT_THAT(study->WithdrawConsent(subject.id, {2026, 5, 20}, "", NextStamp()), IsOk());

  auto past = store::AsOf(study.record(), then);
  ASSERT_THAT(past, IsOk());
  const auto row = past->Results()->front();
  EXPECT_EQ(row.measurement.value, 4.0);
  EXPECT_EQ(row.excluded, std::nullopt);
  EXPECT_TRUE(row.subject.HasActiveConsent());
  EXPECT_EQ(study->Results()->front().measurement.value, 5.0);
  EXPECT_EQ(past->History(capture.id.ToString())->size() + 1, study->History(capture.id.ToString())->size());
}

TEST(AsOf, PutsAReassignedPhotographBackWhereItWas) {
  SmallStudy study;
  const auto by = SignedInAs(study, "cora", store::Role::kCoordinator);
  const Session from = study.Open(study.EnrolWithConsent("S001"));
  const Session to = study.Open(study.EnrolWithConsent("S002"));
  const Capture capture = study.Import(from, "photograph");
  const UtcTime then = NextStamp().now;
  ASSERT_THAT(store::ReassignCaptures(study.record(), std::array{capture.id}, to.id, "wrong patient", by, NextStamp()),
              IsOk());
  auto past = store::AsOf(study.record(), then);
  ASSERT_THAT(past, IsOk());
  EXPECT_EQ((*past->Describe(capture.id.ToString()))["subject"], "S001");
  EXPECT_EQ((*study->Describe(capture.id.ToString()))["subject"], "S002");
}

TEST(AsOf, NowIsTheStudyItself) {
  SmallStudy study;
  const Capture capture = study.Import(study.Open(study.EnrolWithConsent("S001")), "photograph");
  ASSERT_THAT(study->AddReport(CountedId<ReportId>(), capture.id, WoundReport(capture, 4.0), NextStamp()), IsOk());
  auto now = store::AsOf(study.record(), NextStamp().now);
  ASSERT_THAT(now, IsOk());
  for (const std::string& id : {std::string("S001"), capture.id.ToString(), capture.session.ToString(),
                                capture.sha256.ToString(), study->Results()->front().id.ToString()}) {
    EXPECT_EQ(*now->Describe(id), *study->Describe(id)) << id;
  }
}

TEST(AsOf, IsNeverWrittenTo) {
  SmallStudy study;
  const Subject subject = study.Enrol("S001");
  auto now = store::AsOf(study.record(), NextStamp().now);
  ASSERT_THAT(now, IsOk());
  EXPECT_FALSE(now->GiveConsent(subject.id, {2026, 5, 1}, NextStamp()));
  EXPECT_FALSE(study->SubjectById(subject.id)->HasActiveConsent());
}

TEST(AsOf, BeforeTheStudyThereIsNothing) {
  SmallStudy study;
  EXPECT_THAT(store::AsOf(study.record(), UtcTime{0}), FailsWith(ErrorCode::kNotFound, "no study yet"));
}

}  // namespace
}  // namespace striae::testing
