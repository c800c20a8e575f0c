// `check` names what is wrong, wherever someone has tampered.
#include <fstream>

#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

namespace fs = std::filesystem;
using store::CheckReport;
using store::Finding;

/// A finding about that place with those words.
MATCHER_P2(Names, where, what, "") {
  for (const Finding& finding : arg.findings) {
    if (finding.where.find(where) != std::string::npos && finding.what.find(what) != std::string::npos) return true;
    *result_listener << finding.where << ": " << finding.what << "\n";
  }
  return false;
}

/// A study with one measured photograph.
class Check : public ::testing::Test {
 protected:
  Check() {
    session_ = study_.Open(study_.EnrolWithConsent("S001"));
    capture_ = study_.Import(session_, "a photograph");
    outcome_ = *study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 3.5), NextStamp());
  }
  CheckReport Now() { return *study_->Check(); }
  void Raw(const std::string& sql) { ASSERT_EQ(RawSql(study_.database(), sql), ""); }

  SmallStudy study_;
  Session session_;
  Capture capture_;
  store::Outcome outcome_;
};

TEST_F(Check, PassesASoundStudy) {
  const CheckReport report = Now();
  EXPECT_TRUE(report.Passed());
  EXPECT_TRUE(report.findings.empty());
  EXPECT_EQ(report.objects, 1);
  // study, site, subject, consent, visit, session, object, capture, outcome, two measurements
  EXPECT_EQ(report.audit_rows, 11);
  EXPECT_EQ(report.head.hash, study_->Head()->hash);
}

TEST_F(Check, NamesTheAuditRowInWhichAnyFieldWasAltered) {
  const char* columns[] = {"utc",       "utc_offset_min", "zone",      "user",   "machine", "software", "entity",
                           "entity_id", "new_value",      "old_value", "reason", "field",   "action"};
  for (const char* column : columns) {
    SmallStudy study;
    study.EnrolWithConsent("S001");
    const std::string value = std::string(column) == "utc"              ? "'2026-01-01T00:00:00.000Z'"
                              : std::string(column) == "utc_offset_min" ? "0"
                                                                        : "'{}'";
    ASSERT_EQ(RawSql(study.database(), "DROP TRIGGER audit_no_update; UPDATE audit SET " + std::string(column) + " = " +
                                           value + " WHERE sequence = 3"),
              "");
    EXPECT_THAT(*study->Check(), Names("audit row 3", "was altered")) << column;
  }
}

TEST_F(Check, NamesARowWhoseHashWasRecomputedWithoutThoseAfterIt) {
  Raw("DROP TRIGGER audit_no_update; UPDATE audit SET hash = '" + std::string(64, 'a') + "' WHERE sequence = 4");
  EXPECT_THAT(Now(), Names("audit row 4", "was altered"));
  EXPECT_THAT(Now(), Names("audit row 5", "does not follow on row 4"));
}

TEST_F(Check, NamesAMissingAuditRow) {
  Raw("DROP TRIGGER audit_no_delete; DELETE FROM audit WHERE sequence IN (5, 6)");
  EXPECT_THAT(Now(), Names("audit row 7", "rows 5 to 6"));
}

TEST_F(Check, SeesThatTheTrailWasCutAtItsEnd) {
  const store::AuditHead noted = *study_->Head();
  // Cut so that each row that stays still fits: only a head noted earlier tells.
  Raw("DROP TRIGGER audit_no_delete; DROP TRIGGER measurement_no_delete; "
      "DELETE FROM measurement WHERE number = 2; DELETE FROM audit WHERE sequence = 11");
  EXPECT_TRUE(Now().Passed());
  const auto against_noted = study_->Check(noted);
  EXPECT_FALSE(against_noted->Passed());
  EXPECT_THAT(*against_noted, Names("audit trail", "cut at its end"));
}

TEST_F(Check, SeesThatTheTrailWasCutEvenWithoutANotedHeadWhenTheRowsStay) {
  Raw("DROP TRIGGER audit_no_delete; DELETE FROM audit WHERE sequence > 9");
  EXPECT_THAT(Now(), Names("measurement", "has no audit row"));
}

TEST_F(Check, HoldsAHeadNotedEarlierAgainstTheChain) {
  const store::AuditHead noted = *study_->Head();
  study_.Enrol("S002");
  EXPECT_TRUE(study_->Check(noted)->Passed()) << "the trail has only grown since";
  store::AuditHead other = noted;
  other.hash.bytes[0] ^= 1;
  EXPECT_THAT(*study_->Check(other), Names("audit row 11", "rewritten"));
}

TEST_F(Check, NamesARowChangedPastTheTrail) {
  Raw("DROP TRIGGER measurement_no_update; UPDATE measurement SET value = 0.1 WHERE name = 'volume'");
  const CheckReport report = Now();
  EXPECT_FALSE(report.Passed());
  EXPECT_THAT(report, Names("measurement", "(value)"));
  Raw("UPDATE capture SET role = 'neutral'");  // a column that the record itself may change
  EXPECT_THAT(Now(), Names("capture " + capture_.id.ToString(), "(role)"));
}

TEST_F(Check, NamesARowThatWasAddedOrRemovedPastTheTrail) {
  Raw("INSERT INTO site VALUES ('somewhere', 'XX', 'X', '')");
  EXPECT_THAT(Now(), Names("site somewhere", "has no audit row"));
  Raw("DROP TRIGGER measurement_no_delete; DELETE FROM measurement WHERE name = 'volume'");
  EXPECT_THAT(Now(), Names("measurement", "not in the record"));
}

TEST_F(Check, NamesDamagedLostAndStrangeFiles) {
  const fs::path object = study_->objects().PathOf(capture_.sha256);
  fs::permissions(object, fs::perms::owner_write, fs::perm_options::add);
  fs::resize_file(object, 5);
  EXPECT_THAT(Now(), Names("object " + capture_.sha256.ToString(), "altered or cut (5 bytes)"));
  fs::remove(object);
  EXPECT_THAT(Now(), Names("object " + capture_.sha256.ToString(), "missing"));
  EXPECT_FALSE(Now().Passed());
}

TEST_F(Check, WhatAKilledImportLeftIsNamedButIsNoError) {
  std::ofstream(study_.folder() / "objects/.part-Zz9Yy8") << "half a photo";
  const Sha256 kept_without_row = *study_->objects().Put(Bytes("killed before its row"));
  const CheckReport report = Now();
  EXPECT_TRUE(report.Passed());
  EXPECT_THAT(report, Names(".part-Zz9Yy8", "unfinished"));
  EXPECT_THAT(report, Names(kept_without_row.ToString(), "importing the file again"));
  study_.Import(session_, "killed before its row");
  EXPECT_EQ(Now().findings.size(), 1U);
}

TEST_F(Check, NotesAClockThatWasSetBackAndKeepsTheOrder) {
  store::Stamp yesterday = NextStamp();
  yesterday.now.unix_ms -= 86'400'000;
  ASSERT_THAT(study_->AddSubject({CountedId<SubjectId>(), "S002", study_.site(), {}, {}}, yesterday), IsOk());
  EXPECT_TRUE(Now().Passed());
  EXPECT_THAT(Now(), Names("audit row 12", "set back"));
}

TEST_F(Check, SurvivesARowThatCannotBeRead) {
  Raw("DROP TRIGGER audit_no_update; UPDATE audit SET hash = 'no hash' WHERE sequence = 3");
  EXPECT_FALSE(Now().Passed());
  EXPECT_EQ(Now().objects, 1) << "the other parts are still checked";
}

}  // namespace
}  // namespace striae::testing
