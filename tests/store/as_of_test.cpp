// The study as it stood at any time, rebuilt from its trail.
#include "store/as_of.h"

#include "store/annotations.h"
#include "store/reassign.h"
#include "tests/store/signed_in.h"
#include "tests/store/sites.h"

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

/// Both copies gave the same names and numbers; what each knew before they came together must not get in the way.
TEST(AsOf, WorksOnCopiesThatCameTogetherForEveryTimeBetween) {
  Sites sites;
  std::vector<UtcTime> times;
  {
    auto a = sites.Open("a"), b = sites.Open("b");
    times.push_back(NextStamp().now);
    for (store::Record* copy : {&a, &b}) {
      Enrol(*copy, "S002");
      times.push_back(NextStamp().now);
      ASSERT_THAT(copy->AddCapture(SmallStudy::Photograph(sites.session_), Bytes("the card"), NextStamp()), IsOk());
      ASSERT_THAT(
          copy->AddReport(CountedId<ReportId>(), sites.capture_.id, WoundReport(sites.capture_, 3.6), NextStamp()),
          IsOk());
    }
  }
  sites.Merge("a", "b");
  auto merged = sites.Open("a");
  times.push_back(NextStamp().now);
  ASSERT_THAT(merged.SetRole(sites.capture_.id, *CaptureRole::Parse("wound:W2"), "seen again", NextStamp()), IsOk());
  for (const UtcTime& time : times) {
    auto past = store::AsOf(merged, time);
    ASSERT_THAT(past, IsOk()) << time.ToString();
    EXPECT_THAT(past->Results(), IsOk());
    EXPECT_EQ(past->CaptureById(sites.capture_.id)->role.ToString(), "unassigned");
  }
  EXPECT_EQ(store::AsOf(merged, times.front())->Subjects()->size(), 1U);
  auto before = store::AsOf(merged, times.back());
  EXPECT_EQ(before->Subjects()->size(), 3U);
  EXPECT_EQ(before->Results()->size(), merged.Results()->size());
  auto now = store::AsOf(merged, NextStamp().now);
  for (const std::string& id : {sites.capture_.id.ToString(), sites.session_.id.ToString(), std::string("S002")}) {
    EXPECT_EQ(*now->Describe(id), *merged.Describe(id)) << id;
  }
}

/// The clock of one copy is an hour ahead; its change was known to who changed it back.
TEST(AsOf, FollowsWhoKnewWhatAndNotTheClocks) {
  Sites sites;
  const auto role = [](const char* text) { return *CaptureRole::Parse(text); };
  {
    auto b = sites.Open("b");
    store::Stamp ahead = NextStamp();
    ahead.now.unix_ms += 3'600'000;
    ASSERT_THAT(b.SetRole(sites.capture_.id, role("wound:W2"), "seen again", ahead), IsOk());
  }
  sites.Merge("a", "b");
  auto a = sites.Open("a");
  ASSERT_THAT(a.SetRole(sites.capture_.id, role("wound:W1"), "it is W1", NextStamp()), IsOk());
  ASSERT_EQ(a.CaptureById(sites.capture_.id)->role.ToString(), "wound:W1");
  UtcTime later = NextStamp().now;
  later.unix_ms += 7'200'000;
  auto past = store::AsOf(a, later);
  ASSERT_THAT(past, IsOk());
  EXPECT_EQ(past->CaptureById(sites.capture_.id)->role.ToString(), "wound:W1");
}

}  // namespace
}  // namespace striae::testing
