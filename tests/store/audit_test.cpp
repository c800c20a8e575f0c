// The audit trail: every change is in it, and nobody rewrites it.
#include "store/detail/audit_hash.h"
#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

using store::AuditRow;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(AuditTrail, SaysWhoWhenWhereWhatAndWhy) {
  SmallStudy study;
  const Subject subject = study.EnrolWithConsent("S001");
  const store::Stamp stamp{{1'777'900'000'123}, "nurse", "bedside", "Europe/Ljubljana", 120};
  ASSERT_THAT(study->WithdrawConsent(subject.id, {2026, 5, 9}, "moved away", stamp), IsOk());
  const auto rows = study->History("S001");
  ASSERT_THAT(rows, IsOk());
  ASSERT_EQ(rows->size(), 3U);
  const AuditRow& enrolled = rows->front();
  EXPECT_EQ(enrolled.action, "create");
  EXPECT_EQ(enrolled.entity, "subject");
  EXPECT_EQ(enrolled.entity_id, subject.id.ToString());
  EXPECT_EQ(enrolled.old_value, std::nullopt);
  EXPECT_EQ(nlohmann::json::parse(*enrolled.new_value).at("pseudonym"), "S001");
  const AuditRow& withdrawn = rows->back();
  EXPECT_EQ(withdrawn.stamp.user, "nurse");
  EXPECT_EQ(withdrawn.stamp.machine, "bedside");
  EXPECT_EQ(withdrawn.stamp.now, stamp.now);
  EXPECT_EQ(withdrawn.stamp.zone, "Europe/Ljubljana");
  EXPECT_EQ(withdrawn.stamp.utc_offset_min, 120);
  EXPECT_EQ(withdrawn.reason, "moved away");
  EXPECT_EQ(withdrawn.software, "striae " + std::string(StriaeVersion()));
}

TEST(AuditTrail, AChangedFieldHasItsOldAndNewValue) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  const Capture capture = study.Import(session, "photo", "neutral");
  ASSERT_THAT(study->SetRole(capture.id, *CaptureRole::Parse("pose"), "entered wrongly", NextStamp()), IsOk());
  const auto rows = study->History(capture.id.ToString());
  ASSERT_EQ(rows->size(), 2U);
  EXPECT_EQ(rows->back().field, "role");
  EXPECT_EQ(rows->back().old_value, "\"neutral\"");
  EXPECT_EQ(rows->back().new_value, "\"pose\"");
  EXPECT_EQ(rows->back().reason, "entered wrongly");
}

TEST(AuditTrail, GrowsByNothingWhenAChangeIsRefused) {
  SmallStudy study;
  const Session session = study.Open(study.Enrol("S001"));
  const auto head = study->Head();
  EXPECT_FALSE(study->AddCapture(SmallStudy::Photograph(session), Bytes("photo"), NextStamp()));
  EXPECT_FALSE(study->AddSubject({CountedId<SubjectId>(), "S001", study.site(), {}, {}}, NextStamp()));
  EXPECT_EQ(study->Head()->hash, head->hash);
}

TEST(AuditTrail, IsChainedByTheDocumentedBytes) {
  // Written out by hand from the description in audit_hash.h, for a first row.
  AuditRow row;
  row.origin = "o";
  row.sequence = 1;
  row.stamp = {{0}, "u", "m", "", -60};
  row.software = "s";
  row.action = "create";
  row.entity = "e";
  row.entity_id = "i";
  row.new_value = "{}";
  row.reason = "";
  const std::string text =
      std::string(32, '\0') + "1:o1:124:1970-01-01T00:00:00.000Z3:-600:1:u1:m1:s6:create1:e1:i0:-2:{}0:";
  EXPECT_EQ(store::detail::HashOf(row), store::HashOf(Bytes(text)));
}

TEST(AuditTrail, EachRowHoldsTheHashOfTheOneBefore) {
  SmallStudy study;
  study.EnrolWithConsent("S001");
  const auto rows = study->History("S001");
  ASSERT_EQ(rows->size(), 2U);
  EXPECT_EQ(rows->at(1).previous_hash, rows->at(0).hash);
  EXPECT_EQ(study->Head()->hash, rows->at(1).hash);
  EXPECT_EQ(study->Head()->sequence, rows->at(1).sequence);
}

TEST(AuditTrail, CannotBeRewrittenInPlainSqlite) {
  SmallStudy study;
  study.EnrolWithConsent("S001");
  for (const char* sql : {"UPDATE audit SET user = 'someone else' WHERE sequence = 3", "DELETE FROM audit",
                          "DELETE FROM audit WHERE sequence = 4", "UPDATE audit SET reason = 'x'"}) {
    EXPECT_THAT(RawSql(study.database(), sql), HasSubstr("audit trail is never")) << sql;
  }
  EXPECT_THAT(RawSql(study.database(),
                     "INSERT OR REPLACE INTO audit SELECT origin, 2, utc, utc_offset_min, zone, 'x', "
                     "machine, software, action, entity, entity_id, field, old_value, new_value, "
                     "reason, previous_hash, hash FROM audit WHERE sequence = 2"),
              HasSubstr("grows at its end"));
  EXPECT_TRUE(study->Check()->Passed());
}

TEST(AuditTrail, RowsOfTheStudyAreNeitherDeletedNorRewrittenInPlainSqlite) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  const Capture capture = study.Import(session, "photo");
  ASSERT_THAT(study->AddReport(CountedId<ReportId>(), capture.id, WoundReport(capture, 3.5), NextStamp()), IsOk());
  for (const char* table :
       {"study", "site", "subject", "consent", "visit", "object", "session", "capture", "outcome", "measurement"}) {
    const std::string name = table;
    EXPECT_THAT(RawSql(study.database(), "DELETE FROM " + name), HasSubstr("never deleted"));
    EXPECT_THAT(RawSql(study.database(), "UPDATE " + name + " SET id = 'x'"), HasSubstr("never changed"));
    EXPECT_THAT(RawSql(study.database(), "INSERT OR REPLACE INTO " + name + " SELECT * FROM " + name),
                HasSubstr("there already"));
  }
  EXPECT_THAT(RawSql(study.database(), "UPDATE measurement SET value = 0"), HasSubstr("never changed"));
  EXPECT_TRUE(study->Check()->Passed());
}

}  // namespace
}  // namespace striae::testing
