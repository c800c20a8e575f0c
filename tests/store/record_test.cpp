// Making, closing and opening a study; everything that was put in comes out as it was.
#include <fstream>

#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

using store::Record;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Record, KeepsTheStudyAndItsSite) {
  SmallStudy study;
  study.Reopen();
  const auto kept = study->GetStudy();
  ASSERT_THAT(kept, IsOk());
  EXPECT_EQ(kept->protocol, "WND-01");
  EXPECT_EQ(kept->title, "Healing of leg ulcers");
  EXPECT_EQ(kept->sponsor, "Example Institute");
  EXPECT_EQ(kept->coordinating_centre, "Example Centre");
  const auto sites = study->Sites();
  ASSERT_EQ(sites->size(), 1U);
  EXPECT_EQ(sites->front().id, study.site());
  EXPECT_EQ(sites->front().time_zone, "Europe/Ljubljana");
}

TEST(Record, IsNotMadeOverAnotherOneNorAmongOtherFiles) {
  SmallStudy study;
  const Study other{CountedId<StudyId>(), "X", "X", "X", ""};
  const Site site{CountedId<SiteId>(), "A", "", ""};
  EXPECT_THAT(Record::Create(study.folder(), other, site, CountedUuid(), NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "a study already"));
  std::filesystem::create_directory(study.dir() / "holiday");
  std::ofstream(study.dir() / "holiday/beach.jpg") << "not a study";
  EXPECT_THAT(Record::Create(study.dir() / "holiday", other, site, CountedUuid(), NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "beach.jpg"));
  EXPECT_FALSE(std::filesystem::exists(study.dir() / "holiday/study.db"));
  EXPECT_THAT(Record::Create(study.dir() / "new", Study{}, site, CountedUuid(), NextStamp()),
              FailsWith(ErrorCode::kUsage, "protocol"));
  EXPECT_FALSE(std::filesystem::exists(study.dir() / "new"));
}

TEST(Record, IsMadeWhereAnEarlierInitWasKilled) {
  const TempDir dir;
  std::filesystem::create_directories(dir / "study/objects");
  std::ofstream(dir / "study/.study.db.new") << "half a database";
  const auto record = Record::Create(dir / "study", {CountedId<StudyId>(), "X", "X", "X", ""},
                                     {CountedId<SiteId>(), "A", "", ""}, CountedUuid(), NextStamp());
  EXPECT_THAT(record, IsOk());
  EXPECT_FALSE(std::filesystem::exists(dir / "study/.study.db.new"));
}

TEST(Record, OpensOnlyAStudy) {
  const TempDir dir;
  EXPECT_THAT(Record::Open(dir.path(), NextStamp()), FailsWith(ErrorCode::kNotFound, "striae init"));
  EXPECT_THAT(Record::Open(dir / "nowhere", NextStamp()), FailsWith(ErrorCode::kNotFound, "nowhere"));
  EXPECT_FALSE(std::filesystem::exists(dir / "nowhere"));
  std::ofstream(dir / "study.db") << std::string(8192, 'x');
  EXPECT_THAT(Record::Open(dir.path(), NextStamp()), FailsWith(ErrorCode::kRecordDamaged, "study.db"));
}

TEST(Record, AsksWhoDoesIt) {
  SmallStudy study;
  store::Stamp nobody = NextStamp();
  nobody.user.clear();
  EXPECT_THAT(study->AddSubject({CountedId<SubjectId>(), "S001", study.site(), {}, {}}, nobody),
              FailsWith(ErrorCode::kUsage, "who"));
  EXPECT_THAT(*study->Subjects(), IsEmpty());
}

TEST(Record, KeepsASessionWithItsVisit) {
  SmallStudy study;
  const Subject subject = study.EnrolWithConsent("S001");
  const Session first = study.Open(subject, "V1");
  const Session second = study.Open(subject, "V1");
  study.Reopen();
  const auto kept = study->SessionById(first.id);
  ASSERT_THAT(kept, IsOk());
  EXPECT_EQ(kept->subject, subject.id);
  EXPECT_EQ(kept->operator_name, "coordinator");
  EXPECT_EQ(kept->opened_at, first.opened_at);
  EXPECT_EQ(kept->closed_at, std::nullopt);
  EXPECT_EQ(kept->site_time_zone, "Europe/Ljubljana");
  EXPECT_EQ(kept->camera_clock_offset_s, -37);
  EXPECT_EQ(kept->visit, second.visit) << "a visit of that name is made once";
  EXPECT_EQ(study->VisitById(kept->visit)->name, "V1");
  EXPECT_EQ(study->Visits(subject.id)->size(), 1U);
  const auto sessions = study->Sessions(subject.id);
  ASSERT_EQ(sessions->size(), 2U);
  EXPECT_EQ(sessions->at(0).id, first.id);
}

TEST(Record, ClosesASessionOnce) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  const store::Stamp stamp = NextStamp();
  ASSERT_THAT(study->CloseSession(session.id, stamp), IsOk());
  EXPECT_EQ(study->SessionById(session.id)->closed_at, stamp.now);
  EXPECT_THAT(study->CloseSession(session.id, NextStamp()), FailsWith(ErrorCode::kRecordRefused, "closed at"));
  EXPECT_THAT(study->CloseSession(CountedId<SessionId>(), NextStamp()),
              FailsWith(ErrorCode::kNotFound, "session list"));
}

TEST(Record, RefusesASessionOfNobodyAndMakesNoVisitForIt) {
  SmallStudy study;
  Session session;
  session.id = CountedId<SessionId>();
  session.subject = CountedId<SubjectId>();
  EXPECT_THAT(study->OpenSession(session, "V1", CountedId<VisitId>(), NextStamp()),
              FailsWith(ErrorCode::kNotFound, "no subject"));
  session.subject = study.Enrol("S001").id;
  EXPECT_THAT(study->OpenSession(session, "", CountedId<VisitId>(), NextStamp()),
              FailsWith(ErrorCode::kUsage, "visit"));
  EXPECT_EQ(study->GetOverview()->visits, 0);
}

TEST(Record, SurvivesTextOfEveryKind) {
  SmallStudy study;
  const Subject subject = study.EnrolWithConsent("S001");
  for (const std::string& name : {std::string("; , \" ' \n \t"), std::string("\xC5\xA0tudija \xE2\x82\xAC"),
                                  std::string("x'); DROP TABLE capture; --"), std::string("NULL")}) {
    const Session session = study.Open(subject, name);
    EXPECT_EQ(study->VisitById(session.visit)->name, name);
  }
  // Bytes that are no UTF-8, as an old card can have in a file name, and NUL: replaced, never lost silently.
  const Session session = study.Open(subject, std::string("a\xFF"
                                                          "b\0c",
                                                          5));
  EXPECT_EQ(study->VisitById(session.visit)->name,
            "a\xEF\xBF\xBD"
            "b\xEF\xBF\xBD"
            "c");
  EXPECT_TRUE(study->Check()->Passed());
}

}  // namespace
}  // namespace striae::testing
