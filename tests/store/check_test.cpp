// `check` names what is wrong, wherever someone has tampered.
#include "store/check.h"

#include <algorithm>
#include <fstream>
#include <functional>

#include "store/detail/database.h"
#include "tests/store/findings.h"
#include "tests/store/small_study.h"
#include "tests/support/files.h"

namespace striae::testing {
namespace {

namespace fs = std::filesystem;
using store::CheckReport;

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

  /// As someone would who knows the format: the guards are taken away and put back.
  void RawPastTheGuards(const std::string& sql) {
    store::detail::Database database(study_.database(), false);
    const auto text = [](const store::detail::RowView& row) { return row.Text(0); };
    const auto names = database.Rows("SELECT name FROM sqlite_master WHERE type = 'trigger'", text);
    const auto guards = database.Rows("SELECT sql FROM sqlite_master WHERE type = 'trigger'", text);
    for (const std::string& name : names) database.Execute("DROP TRIGGER " + name);
    database.Execute(sql);
    for (const std::string& guard : guards) database.Execute(guard);
  }
  /// Changes bytes of study.db itself, past SQLite. The study must be closed and its log brought into the file.
  void ChangeFile(const std::function<void(std::vector<std::uint8_t>&)>& change) {
    study_.Close();
    ASSERT_FALSE(fs::exists(study_.database().string() + "-wal"));
    auto bytes = ReadBytes(study_.database());
    change(bytes);
    WriteBytes(study_.database(), bytes);
    study_.Reopen();
  }

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
  RawPastTheGuards("DELETE FROM measurement WHERE number = 2; DELETE FROM audit WHERE sequence = 11");
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
  EXPECT_THAT(Now(), Names("object " + capture_.sha256.ToString(), "was cut: 5 of 12 bytes"));
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

TEST_F(Check, NamesAnObjectWhoseBytesWereChanged) {
  const fs::path object = study_->objects().PathOf(capture_.sha256);
  fs::permissions(object, fs::perms::owner_write, fs::perm_options::add);
  WriteBytes(object, {'A', ' ', 'p', 'h', 'o', 't', 'o', 'g', 'r', 'a', 'p', 'h'});
  EXPECT_THAT(Now(), Names("object " + capture_.sha256.ToString(), "its bytes are not those of its name"));
}

TEST_F(Check, NamesAGuardThatWasTakenAway) {
  Raw("DROP TRIGGER capture_no_delete");
  EXPECT_FALSE(Now().Passed());
  EXPECT_THAT(Now(), Names("study.db", "its trigger capture_no_delete was removed"));
}

TEST_F(Check, NamesTheAuditRowOfAByteFlippedInTheFile) {
  ChangeFile([](std::vector<std::uint8_t>& bytes) {
    const std::string machine = "coordinatordesk";  // user and machine of an audit row lie side by side
    const auto at = std::search(bytes.begin(), bytes.end(), machine.begin(), machine.end());
    ASSERT_NE(at, bytes.end());
    *at = 'k';
  });
  const CheckReport report = Now();
  EXPECT_FALSE(report.Passed());
  EXPECT_THAT(report, Names("audit row ", "was altered: its content does not give its hash"));
  EXPECT_EQ(report.findings.size(), 1U) << "one row was changed, one row is named";
}

TEST_F(Check, NamesACorruptedPage) {
  const auto page = [&] {
    store::detail::Database database(study_.database(), false);
    return database.Count("SELECT rootpage FROM sqlite_master WHERE name = 'capture'");
  }();
  ChangeFile([&](std::vector<std::uint8_t>& bytes) {
    constexpr std::size_t kPage = 4096;  // SQLite's default
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(kPage * static_cast<std::size_t>(page - 1)), 200, 0xA5);
  });
  const CheckReport report = Now();
  EXPECT_FALSE(report.Passed());
  EXPECT_THAT(report, Names("study.db", "Page " + std::to_string(page)));
  EXPECT_THAT(report, Names("table capture", "cannot be read whole"));
  EXPECT_EQ(report.objects, 1) << "the other parts are still checked";
}

TEST_F(Check, HoldsEveryCopysHeadAgainstTheChain) {
  const CheckReport before = Now();
  ASSERT_EQ(before.heads.size(), 1U);
  const auto head = store::ParseHead(ToText(before.heads.front()));
  ASSERT_THAT(head, IsOk());
  EXPECT_EQ(head->origin, before.heads.front().origin);
  store::CheckOptions options;
  options.expected = {*head};
  study_.Enrol("S002");
  EXPECT_TRUE(store::Check(study_.record(), options)->Passed());
  options.expected.front().origin = CountedUuid().ToString();
  EXPECT_THAT(*store::Check(study_.record(), options), Names("audit trail", "it has 0 rows of copy"));
  EXPECT_THAT(store::ParseHead("12:abc"), FailsWith(ErrorCode::kUsage, "NUMBER:HASH"));
  EXPECT_THAT(store::ParseHead("1:" + std::string(64, '0') + " nobody"), FailsWith(ErrorCode::kUsage, "copy's id"));
}

TEST_F(Check, KeepsItsReportShortWhenEverythingIsWrong) {
  std::string sql;
  for (int i = 0; i < 1000; ++i)
    sql += "INSERT INTO site VALUES ('x" + std::to_string(i) + "', 'c" + std::to_string(i) + "', '', '');";
  Raw("BEGIN;" + sql + "COMMIT");
  const CheckReport report = Now();
  EXPECT_LE(report.findings.size(), 2 * store::kMostFindings + 1);
  EXPECT_THAT(report, Names("site", "1000 findings of this kind"));
}

TEST_F(Check, SurvivesARowThatCannotBeRead) {
  Raw("DROP TRIGGER audit_no_update; UPDATE audit SET hash = 'no hash' WHERE sequence = 3");
  EXPECT_FALSE(Now().Passed());
  EXPECT_THAT(Now(), Names("audit row 3", "cannot be read"));
  EXPECT_EQ(Now().objects, 1) << "the other parts are still checked";
}

}  // namespace
}  // namespace striae::testing
