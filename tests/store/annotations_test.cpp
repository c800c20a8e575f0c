// Treatments, notes, queries and exclusions: added, never replaced.
#include "store/annotations.h"

#include "store/json.h"
#include "store/results.h"
#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

using store::QueryState;
using store::Record;

TEST(Treatment, ACorrectionNeedsAReasonAndTheEntryBeforeStaysReadable) {
  SmallStudy study;
  const Subject subject = study.Enrol("S001");
  const store::Treatment first{CountedId<store::TreatmentId>(), subject.id, {2026, 5, 4}, "compression, 40 mmHg"};
  ASSERT_THAT(store::AddTreatment(study.record(), first, "", NextStamp()), IsOk());
  store::Treatment right = first;
  right.id = CountedId<store::TreatmentId>();
  right.text = "compression, 30 mmHg";
  right.supersedes = first.id;
  EXPECT_THAT(store::AddTreatment(study.record(), right, "", NextStamp()),
              FailsWith(ErrorCode::kUsage, "needs a reason"));
  ASSERT_THAT(store::AddTreatment(study.record(), right, "misread", NextStamp()), IsOk());
  const auto now = store::Treatments(study.record(), subject.id);
  ASSERT_EQ(now->size(), 1U);
  EXPECT_EQ(now->front().text, "compression, 30 mmHg");
  EXPECT_EQ(now->front().by, "coordinator");
  EXPECT_EQ((*study->Describe(first.id.ToString()))["text"], "compression, 40 mmHg");
  EXPECT_EQ((*study->Describe("S001"))["treatments"].size(), 1U);
  EXPECT_EQ(RawSql(study.database(), "UPDATE treatment SET text = 'none'"), "treatment rows are never changed here");
}

TEST(Treatment, EnteredInErrorIsNoLongerListedAndStillThere) {
  SmallStudy study;
  const Subject subject = study.Enrol("S001");
  const store::Treatment wrong{CountedId<store::TreatmentId>(), subject.id, {2026, 5, 4}, "another subject's"};
  ASSERT_THAT(store::AddTreatment(study.record(), wrong, "", NextStamp()), IsOk());
  ASSERT_THAT(store::StrikeTreatment(study.record(), wrong.id, CountedId<store::TreatmentId>(), "S002's", NextStamp()),
              IsOk());
  EXPECT_TRUE(store::Treatments(study.record())->empty());
  EXPECT_THAT(study->Describe(wrong.id.ToString()), IsOk());
  EXPECT_THAT(store::StrikeTreatment(study.record(), wrong.id, CountedId<store::TreatmentId>(), "again", NextStamp()),
              FailsWith(ErrorCode::kNotFound, "in force"));
}

TEST(Note, IsAboutAnythingInTheRecordAndBelongsToItsHistory) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  const Record::Found about{"session", session.id.ToString()};
  const auto before = study->History(session.id.ToString())->size();
  ASSERT_THAT(store::AddNote(study.record(), {CountedId<store::NoteId>(), about, true, {2026, 5, 4}, "lamp was cold"},
                             "", NextStamp()),
              IsOk());
  const auto shown = study->Describe(session.id.ToString());
  EXPECT_EQ((*shown)["notes"][0]["kind"], "deviation");
  EXPECT_EQ(study->History(session.id.ToString())->size(), before + 1);
  const Record::Found nowhere{"session", CountedUuid().ToString()};
  EXPECT_THAT(
      store::AddNote(study.record(), {CountedId<store::NoteId>(), nowhere, false, {2026, 5, 4}, "x"}, "", NextStamp()),
      FailsWith(ErrorCode::kNotFound, "nothing in this study"));
}

TEST(Query, IsOpenedAnsweredAndClosed) {
  SmallStudy study;
  const Subject subject = study.Enrol("S001");
  const auto id = CountedId<store::QueryId>();
  ASSERT_THAT(store::OpenQuery(study.record(), id, {"subject", subject.id.ToString()}, "consent date?", NextStamp()),
              IsOk());
  ASSERT_THAT(store::StepQuery(study.record(), id, QueryState::kAnswered, "checked, it is right", NextStamp()), IsOk());
  EXPECT_EQ(store::Queries(study.record())->front().state, QueryState::kAnswered);
  EXPECT_THAT(store::StepQuery(study.record(), id, QueryState::kAnswered, "again", NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "is answered"));
  ASSERT_THAT(store::StepQuery(study.record(), id, QueryState::kClosed, "thanks", NextStamp()), IsOk());
  EXPECT_TRUE(store::Queries(study.record())->empty());
  ASSERT_THAT(store::StepQuery(study.record(), id, QueryState::kOpen, "it is not", NextStamp()), IsOk());
  const auto all = store::Queries(study.record(), true);
  ASSERT_EQ(all->size(), 1U);
  EXPECT_EQ(all->front().steps.size(), 3U);
  EXPECT_THAT(store::StepQuery(study.record(), id, QueryState::kClosed, "", NextStamp()),
              FailsWith(ErrorCode::kUsage, "needs a text"));
}

TEST(Deviation, IsNotedWithItsSessionOrNeitherIsThere) {
  SmallStudy study;
  const Subject subject = study.EnrolWithConsent("S001");
  Session session;
  session.id = CountedId<SessionId>();
  session.subject = subject.id;
  session.operator_name = "coordinator";
  session.opened_at = NextStamp().now;
  session.day = Date{2026, 5, 4};
  ASSERT_THAT(study->OpenSession(session, "V7", CountedId<VisitId>(), NextStamp(), "unscheduled visit V7: pain"),
              IsOk());
  const auto notes = store::Notes(study.record(), session.id.ToString());
  ASSERT_EQ(notes->size(), 1U);
  EXPECT_TRUE(notes->front().deviation);
  EXPECT_EQ(notes->front().date, (Date{2026, 5, 4}));
  // The same session again is refused by its key, and its note is not there twice.
  const auto rows = study->Head()->sequence;
  EXPECT_FALSE(study->OpenSession(session, "V8", CountedId<VisitId>(), NextStamp(), "once more"));
  EXPECT_EQ(study->Head()->sequence, rows);
  EXPECT_EQ(store::Notes(study.record())->size(), 1U);
}

class Excluded : public ::testing::Test {
 protected:
  [[nodiscard]] store::ResultRow Result(const std::string& name) {
    for (const auto& row : std::vector(*study_->Results())) {
      if (row.measurement.name == name) return row;
    }
    ADD_FAILURE() << name;
    return {};
  }
  SmallStudy study_;
  Capture capture_ = study_.Import(study_.Open(study_.EnrolWithConsent("S001")), "photograph");
};

TEST_F(Excluded, StandsInTheListOfAnyLengthAsInTheOneInMemory) {
  ASSERT_THAT(study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 4.0), NextStamp()), IsOk());
  ASSERT_THAT(study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 4.5), NextStamp()), IsOk());
  const Record::Found volume{"measurement", Result("volume").id.ToString()};
  ASSERT_THAT(store::Exclude(study_.record(), CountedId<store::ExclusionId>(), volume, "\"moved\"", NextStamp()),
              IsOk());
  for (const store::ResultFilter& filter : {store::ResultFilter{}, store::ResultFilter{{}, {}, true}}) {
    nlohmann::json whole = nlohmann::json::array(), pieces = nlohmann::json::array();
    const auto rows = *study_->Results(filter);
    for (const store::ResultRow& row : rows) whole.push_back(store::ToJson(row));
    ASSERT_THAT(store::EachResult(study_.record(), filter,
                                  [&](const store::ResultRow& row, const std::string& json) {
                                    pieces.push_back(nlohmann::json::parse(json));
                                    EXPECT_EQ(pieces.back().at("name"), row.measurement.name);
                                    EXPECT_EQ(pieces.back().at("value"), row.measurement.value);
                                    EXPECT_EQ(pieces.back().value("reason", ""), row.measurement.reason);
                                  }),
                IsOk());
    EXPECT_EQ(pieces, whole);
  }
}

TEST_F(Excluded, ACaptureTakesAllItsNumbersWithItAndTheyStayListed) {
  ASSERT_THAT(study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 4.0), NextStamp()), IsOk());
  const Record::Found target{"capture", capture_.id.ToString()};
  EXPECT_THAT(store::Exclude(study_.record(), CountedId<store::ExclusionId>(), target, "", NextStamp()),
              FailsWith(ErrorCode::kUsage, "needs a reason"));
  ASSERT_THAT(store::Exclude(study_.record(), CountedId<store::ExclusionId>(), target, "moved", NextStamp()), IsOk());
  EXPECT_EQ(Result("volume").excluded, "moved");
  EXPECT_EQ(Result("depth_max").excluded, "moved");
  EXPECT_THAT(store::Exclude(study_.record(), CountedId<store::ExclusionId>(), target, "twice", NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "excluded already"));
  ASSERT_THAT(store::Include(study_.record(), CountedId<store::ExclusionId>(), target, "it did not", NextStamp()),
              IsOk());
  EXPECT_EQ(Result("volume").excluded, std::nullopt);
  EXPECT_TRUE(study_->Check()->Passed());
}

TEST_F(Excluded, AQuantityStaysExcludedWhenItIsComputedAgain) {
  ASSERT_THAT(study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 4.0), NextStamp()), IsOk());
  const Record::Found target{"measurement", Result("volume").id.ToString()};
  ASSERT_THAT(store::Exclude(study_.record(), CountedId<store::ExclusionId>(), target, "glare", NextStamp()), IsOk());
  ASSERT_THAT(study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 5.0), NextStamp()), IsOk());
  EXPECT_EQ(Result("volume").measurement.value, 5.0);
  EXPECT_EQ(Result("volume").excluded, "glare");
  EXPECT_EQ(Result("depth_max").excluded, std::nullopt);
}

TEST_F(Excluded, AreOnlyCapturesAndMeasurements) {
  EXPECT_THAT(store::Exclude(study_.record(), CountedId<store::ExclusionId>(), {"session", capture_.session.ToString()},
                             "why not", NextStamp()),
              FailsWith(ErrorCode::kUsage, "not a session"));
}

}  // namespace
}  // namespace striae::testing
