// Two programs at once, and studies of an older format.
#include <thread>

#include "store/detail/schema.h"
#include "store/visits.h"
#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

using store::detail::Database;

TEST(Waiting, ASecondWriterIsToldAndGoesOnWhenTheFirstHasFinished) {
  SmallStudy study;
  auto first = std::make_unique<Database>(study.database(), false);
  first->Execute("BEGIN IMMEDIATE");
  int told = 0;
  study->WhenBusy([&] { ++told; });
  // Longer than the half second after which one is told, shorter than the patience of ten seconds.
  std::thread finish([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));
    first->Execute("COMMIT");
  });
  const Status added = study->AddSubject({CountedId<SubjectId>(), "S001", study.site(), {}, {}}, NextStamp());
  finish.join();
  EXPECT_THAT(added, IsOk());
  EXPECT_EQ(told, 1);
}

TEST(Waiting, AReaderNeverWaitsForAWriter) {
  SmallStudy study;
  study.Enrol("S001");
  Database writer(study.database(), false);
  writer.Execute("BEGIN IMMEDIATE");
  int told = 0;
  study->WhenBusy([&] { ++told; });
  EXPECT_EQ(study->Subjects()->size(), 1U);
  EXPECT_EQ(told, 0);
  writer.Execute("ROLLBACK");
}

/// A study as the first released format wrote it: only migration 1, and rows that its audit trail does not tell of.
void MakeFirstFormat(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "objects");
  Database old(folder / "study.db", true);
  old.Execute("PRAGMA application_id=" + std::to_string(store::detail::kApplicationId));
  old.Execute(store::detail::Migrations().front());
  old.Execute(R"sql(
    INSERT INTO this_copy VALUES (1, '00000000-0000-4000-8000-000000000001');
    INSERT INTO study VALUES ('00000000-0000-4000-8000-000000000002', 'WND-01', 'Healing', 'Example Institute', '');
    INSERT INTO site VALUES ('00000000-0000-4000-8000-000000000003', 'LJ', 'Example Clinic', 'Europe/Ljubljana');
    INSERT INTO subject VALUES ('00000000-0000-4000-8000-000000000004', 'S001', '00000000-0000-4000-8000-000000000003');
    INSERT INTO consent VALUES ('00000000-0000-4000-8000-000000000005', '00000000-0000-4000-8000-000000000004', 1,
      'given', '2026-05-01');
    INSERT INTO visit VALUES ('00000000-0000-4000-8000-000000000006', '00000000-0000-4000-8000-000000000004', 'V1');
    INSERT INTO session VALUES ('00000000-0000-4000-8000-000000000007', '00000000-0000-4000-8000-000000000004',
      '00000000-0000-4000-8000-000000000006', 'coordinator', '2026-05-04T10:00:00.000Z', NULL, '', NULL);
    PRAGMA user_version=1;)sql");
}

TEST(OlderFormat, IsKeptBesideAndThenWorksWithAllThatIsNew) {
  const TempDir dir;
  MakeFirstFormat(dir / "old");
  auto record = store::Record::Open(dir / "old", NextStamp());
  ASSERT_THAT(record, IsOk());
  const auto newest = std::to_string(store::detail::Migrations().size());
  Database copy(dir / "old" / ("study.db.before-" + newest), false);
  EXPECT_EQ(copy.UserVersion(), 1);
  EXPECT_EQ(copy.Count("SELECT count(*) FROM subject"), 1);
  EXPECT_EQ(copy.Count("SELECT count(*) FROM sqlite_master WHERE name = 'user'"), 0);

  EXPECT_EQ(record->GetStudy()->subject_pattern, "");
  const Subject subject = *record->SubjectByPseudonym("S001");
  EXPECT_EQ(record->Sessions(subject.id)->front().day, std::nullopt);
  ASSERT_THAT(store::PlanVisit(*record, {CountedId<store::PlannedVisitId>(), "V1", {}, 0, 0, 5}, NextStamp()), IsOk());
  const auto states = store::VisitStates(*record, {2026, 6, 1});
  EXPECT_EQ(states->front().held, (Date{2026, 5, 4})) << "an old session counts by its UTC day";
  EXPECT_THAT(record->CloseSession(*SessionId::Parse("00000000-0000-4000-8000-000000000007"), NextStamp()), IsOk());
}

}  // namespace
}  // namespace striae::testing
