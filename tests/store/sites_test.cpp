// A study with several sites.
#include "store/sites.h"

#include "store/locks.h"
#include "tests/store/signed_in.h"
#include "tests/store/sites.h"

namespace striae::testing {
namespace {

Site NewSite(const std::string& code) { return {CountedId<SiteId>(), code, "Example Hospital", "Europe/Vienna"}; }

TEST(StudySites, AreAddedWithTheirTrailAndHoldSubjects) {
  SmallStudy study;
  const Site site = NewSite("MB");
  ASSERT_THAT(store::AddSite(study.record(), site, NextStamp()), IsOk());
  ASSERT_THAT(study->AddSubject({CountedId<SubjectId>(), "S101", site.id, {}, {}}, NextStamp()), IsOk());
  study.Reopen();
  const auto sites = study->Sites();
  ASSERT_EQ(sites->size(), 2U);
  EXPECT_EQ(sites->back().code, "MB");
  EXPECT_EQ(sites->back().time_zone, "Europe/Vienna");
  EXPECT_EQ(study->SubjectByPseudonym("S101")->site, site.id);
  EXPECT_EQ(study->History(site.id.ToString())->front().action, "create");
  EXPECT_TRUE(study->Check()->findings.empty());
}

TEST(StudySites, HaveACodeOfTheirOwn) {
  SmallStudy study;
  EXPECT_THAT(store::AddSite(study.record(), NewSite("lj"), NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "there already"));
  for (const char* code : {"", "A B", "seventeen letters"}) {
    EXPECT_THAT(store::AddSite(study.record(), NewSite(code), NextStamp()), FailsWith(ErrorCode::kUsage, "code"))
        << code;
  }
  EXPECT_EQ(study->Sites()->size(), 1U);
}

TEST(StudySites, GivenTheSameCodeAtTwoCopiesStayApart) {
  Sites copies;
  {
    auto a = copies.Open("a"), b = copies.Open("b");
    ASSERT_THAT(store::AddSite(a, NewSite("MB"), NextStamp()), IsOk());
    ASSERT_THAT(store::AddSite(b, NewSite("MB"), NextStamp()), IsOk());
  }
  EXPECT_EQ(copies.BothWays(), "");
  EXPECT_EQ(copies.Open("a").Sites()->size(), 3U);
}

/// What the whole study shares stays as it is while the study is locked, in any program.
TEST(StudyLock, KeepsSitesArmsDevicesCalibrationsAndChecks) {
  SmallStudy study;
  const auto by = SignedInAs(study, "anna", store::Role::kInvestigator);
  const Device device{CountedId<DeviceId>(), "6123456", RigRange::kSmall, "NIKON D90", "50 mm"};
  ASSERT_THAT(study->AddDevice(device, NextStamp()), IsOk());
  ASSERT_THAT(store::AddLock(study.record(), CountedId<store::LockId>(), {"study", study->GetStudy()->id.ToString()},
                             "database lock", by, NextStamp()),
              IsOk());
  EXPECT_THAT(store::AddSite(study.record(), NewSite("MB"), NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "the study is locked"));
  const std::string known = "(SELECT id FROM device)";
  for (const std::string& sql :
       {std::string("INSERT INTO site VALUES ('1', 'X', '', '')"), std::string("INSERT INTO arm VALUES ('1', 'X', '')"),
        std::string("INSERT INTO device VALUES ('1', 'X', 'small', '', '')"),
        "INSERT INTO calibration VALUES ('1', " + known + ", 9, 'x', '2026-01-01')",
        "INSERT INTO device_check VALUES ('1', " + known + ", 9, 'plane', 'a', 'b', 0, 'x', '{}', 'x', 'x')"}) {
    EXPECT_THAT(RawSql(study.database(), sql), ::testing::HasSubstr("the study is locked")) << sql;
  }
}

}  // namespace
}  // namespace striae::testing
