#include "store/detail/schema.h"

#include <sstream>

namespace striae::store::detail {
namespace {

/// Nothing in a study is deleted, and rows are not replaced in passing by INSERT OR REPLACE. `frozen` lists the columns
/// that never change ("" = all). Released migrations use it: do not edit.
std::string Guards(const std::string& table, const std::string& frozen) {
  const std::string columns = frozen.empty() ? "" : " OF " + frozen;
  return "CREATE TRIGGER " + table + "_no_delete BEFORE DELETE ON " + table + " BEGIN SELECT RAISE(ABORT, '" + table +
         " rows are never deleted'); END;\nCREATE TRIGGER " + table + "_no_update BEFORE UPDATE" + columns + " ON " +
         table + " BEGIN SELECT RAISE(ABORT, '" + table + " rows are never changed here'); END;\nCREATE TRIGGER " +
         table + "_no_replace BEFORE INSERT ON " + table + " WHEN EXISTS (SELECT 1 FROM " + table +
         " WHERE id = NEW.id) BEGIN SELECT RAISE(ABORT, '" + table + " row is there already'); END;\n";
}

}  // namespace

std::string ExpandGuards(std::string_view sql) {
  constexpr std::string_view kMark = "--guard ";
  std::istringstream lines{std::string(sql)};
  std::string expanded, line;
  while (std::getline(lines, line)) {
    if (!line.starts_with(kMark)) {
      expanded.append(line).append("\n");
      continue;
    }
    const std::string what = line.substr(kMark.size());
    const auto space = what.find(' ');
    expanded += Guards(what.substr(0, space), space == std::string::npos ? "" : what.substr(space + 1));
  }
  return expanded;
}

const std::vector<std::string>& Migrations() {
  static const std::vector<std::string> migrations = [] {
    std::vector<std::string> all;
    for (const std::string_view sql : MigrationFiles()) all.push_back(ExpandGuards(sql));
    return all;
  }();
  return migrations;
}

std::vector<std::string> AuditedTables(Database& database) {
  return database.Rows(
      "SELECT m.name FROM sqlite_master m JOIN pragma_table_info(m.name) c ON c.name = 'id' WHERE m.type = 'table' "
      "ORDER BY m.rowid",
      [](const RowView& row) { return row.Text(0); });
}

void Migrate(Database& database, const std::vector<std::string>& migrations) {
  const auto target = static_cast<std::int64_t>(migrations.size());
  database.Execute("BEGIN IMMEDIATE");
  try {
    // Read within the transaction: another program may have migrated the file meanwhile.
    for (auto version = database.UserVersion(); version < target; ++version) {
      database.Execute(migrations[static_cast<std::size_t>(version)]);
    }
    database.Execute("PRAGMA user_version=" + std::to_string(target));
    database.Execute("COMMIT");
  } catch (...) {
    database.Execute("ROLLBACK");
    throw;
  }
}

void BringUpToDate(Database& database, const std::filesystem::path& file, const std::vector<std::string>& migrations) {
  const auto known = static_cast<std::int64_t>(migrations.size());
  const std::int64_t found = database.UserVersion();
  if (database.Count("PRAGMA application_id") != kApplicationId || found < 1) {
    Refuse(ErrorCode::kRecordDamaged, file.string() + " is not a Striae study; check -C DIR, or restore a backup");
  }
  if (found > known) {
    Refuse(ErrorCode::kRecordRefused, "this study was written by a newer Striae (format " + std::to_string(found) +
                                          ", this program knows up to " + std::to_string(known) +
                                          "); install the newer version");
  }
  if (found == known) return;
  std::filesystem::path copy = file;
  copy += ".before-" + std::to_string(known);
  if (!std::filesystem::exists(copy)) {
    // Written beside and renamed, so that a copy of that name is always whole.
    std::filesystem::path partial = copy;
    partial += ".part";
    std::filesystem::remove(partial);
    database.Run("VACUUM INTO ?", {partial.string()});
    std::filesystem::rename(partial, copy);
  }
  Migrate(database, migrations);
}

}  // namespace striae::store::detail
