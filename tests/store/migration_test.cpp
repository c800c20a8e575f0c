// A study outlives the program that made it.
#include "store/detail/schema.h"
#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

namespace fs = std::filesystem;
using store::Record;
using store::detail::Database;

TEST(Migration, ANewerStudyIsRefusedAndNotTouched) {
  SmallStudy study;
  ASSERT_EQ(RawSql(study.database(), "PRAGMA user_version=999"), "");
  EXPECT_THAT(Record::Open(study.folder(), NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "newer Striae (format 999"));
}

TEST(Migration, AnOlderStudyIsCopiedAndThenBroughtUpToDate) {
  SmallStudy study;
  study.Enrol("S001");
  auto migrations = store::detail::Migrations();
  const auto before = static_cast<std::int64_t>(migrations.size());
  migrations.emplace_back("ALTER TABLE site ADD COLUMN phone TEXT; CREATE TABLE plan (id TEXT PRIMARY KEY) STRICT;");
  const fs::path copy = study.folder() / ("study.db.before-" + std::to_string(before + 1));
  {
    Database database(study.database(), false);
    store::detail::BringUpToDate(database, study.database(), migrations);
    EXPECT_EQ(database.UserVersion(), before + 1);
    EXPECT_EQ(database.Count("SELECT count(*) FROM plan"), 0);
  }
  Database old(copy, false);
  EXPECT_EQ(old.UserVersion(), before);
  EXPECT_EQ(old.Count("SELECT count(*) FROM subject"), 1);
  EXPECT_TRUE(study->Check()->Passed()) << "a new empty column is no change of the rows";
}

TEST(Migration, ThatFailsLeavesTheStudyAsItWas) {
  SmallStudy study;
  auto migrations = store::detail::Migrations();
  migrations.emplace_back("CREATE TABLE plan (id TEXT PRIMARY KEY) STRICT; CREATE TABLE subject (x);");
  Database database(study.database(), false);
  EXPECT_FALSE(store::detail::Guarded([&] { store::detail::BringUpToDate(database, study.database(), migrations); }));
  EXPECT_EQ(database.UserVersion(), static_cast<std::int64_t>(migrations.size()) - 1);
  EXPECT_EQ(database.Count("SELECT count(*) FROM sqlite_master WHERE name = 'plan'"), 0);
  EXPECT_TRUE(study->Check()->Passed());
}

TEST(Migration, TheCopyOfAnOlderStudyIsNeverOverwritten) {
  SmallStudy study;
  auto migrations = store::detail::Migrations();
  migrations.emplace_back("CREATE TABLE plan (id TEXT PRIMARY KEY) STRICT;");
  const fs::path copy = study.folder() / ("study.db.before-" + std::to_string(migrations.size()));
  fs::copy_file(study.database(), copy);
  const auto size = fs::file_size(copy);
  fs::resize_file(copy, size - 1);
  Database database(study.database(), false);
  store::detail::BringUpToDate(database, study.database(), migrations);
  EXPECT_EQ(fs::file_size(copy), size - 1);
}

TEST(Migration, AnotherProgramsDatabaseIsNotAStudy) {
  const TempDir dir;
  ASSERT_EQ(RawSql(dir / "study.db", "CREATE TABLE t (x); PRAGMA user_version=1"), "");
  EXPECT_THAT(Record::Open(dir.path(), NextStamp()), FailsWith(ErrorCode::kRecordDamaged, "not a Striae study"));
}

TEST(Migration, KeepsTheSettingsThatDurabilityRestsOn) {
  SmallStudy study;
  Database database(study.database(), false);
  database.Configure();
  const auto text = [](const store::detail::RowView& row) { return row.Text(0); };
  EXPECT_EQ(database.One("PRAGMA journal_mode", text), "wal");
  EXPECT_EQ(database.One("PRAGMA synchronous", text), "2");  // FULL
  EXPECT_EQ(database.One("PRAGMA foreign_keys", text), "1");
  EXPECT_EQ(
      database.Count("SELECT count(*) FROM pragma_table_list WHERE schema = 'main' AND type = 'table' AND strict = 0 "
                     "AND name NOT LIKE 'sqlite_%'"),
      0)
      << "every table is STRICT";
}

}  // namespace
}  // namespace striae::testing
