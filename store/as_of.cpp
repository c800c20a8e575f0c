#include "store/as_of.h"

#include <map>
#include <regex>
#include <set>

#include "store/detail/audit_hash.h"
#include "store/detail/merge_rows.h"
#include "store/detail/schema.h"
#include "store/detail/words.h"

namespace striae::store {
namespace {

using nlohmann::json;

Value ValueOf(const json& value) {
  if (value.is_null()) return {};
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (value.is_number()) return value.get<double>();
  if (value.is_string()) return value.get<std::string>();
  Refuse(ErrorCode::kRecordDamaged, "the audit trail holds a value that no column can have; run 'striae check'");
}

/// A name from the trail stands in SQL: only one that the schema has.
class Names {
 public:
  explicit Names(Database& database) : database_(database) {}
  bool IsTable(const std::string& table) { return !ColumnsOf(table).empty(); }
  void Check(const std::string& table, const std::string& column) {
    if (!ColumnsOf(table).contains(column)) {
      Refuse(ErrorCode::kRecordDamaged,
             "the audit trail names a column that is not there: " + table + "." + column + "; run 'striae check'");
    }
  }

 private:
  const std::set<std::string>& ColumnsOf(const std::string& table) {
    const auto [place, fresh] = known_.try_emplace(table);
    if (fresh) {
      for (const std::string& name : database_.Rows(
               "SELECT name FROM pragma_table_info(?)", [](const RowView& row) { return row.Text(0); }, table)) {
        place->second.insert(name);
      }
    }
    return place->second;
  }
  Database& database_;
  std::map<std::string, std::set<std::string>> known_;
};

/// A row as it was made. What became of it later, Settle says.
void Make(Database& past, Names& names, const AuditRow& row) {
  if (row.action != "create" || !names.IsTable(row.entity)) return;
  const json value = json::parse(row.new_value.value_or("null"));
  std::string columns, marks;
  std::vector<Value> values;
  for (const auto& [column, cell] : value.items()) {
    names.Check(row.entity, column);
    columns += (columns.empty() ? "" : ", ") + column;
    marks += marks.empty() ? "?" : ", ?";
    values.push_back(ValueOf(cell));
  }
  // Two united copies can both tell of the same row.
  past.Run("INSERT INTO " + row.entity + " (" + columns + ") VALUES (" + marks + ") ON CONFLICT (id) DO NOTHING",
           values);
}

/// Every row that was changed, or made at two copies, as the trail until then says it: which of two changes counts is
/// no matter of their times alone (store/detail/trail.h).
void Settle(Database& past, Names& names) {
  const detail::Knowledge knowledge(past);
  const auto entities = past.Rows(
      "SELECT entity, entity_id FROM audit WHERE action IN ('create', 'change') GROUP BY entity, entity_id HAVING "
      "count(*) > 1",
      [](const RowView& row) { return std::pair(row.Text(0), row.Text(1)); });
  for (const auto& [table, id] : entities) {
    if (!names.IsTable(table)) continue;
    const detail::TrailState state = detail::StateOf(past, table, id, knowledge);
    if (!state.row.is_object()) continue;
    std::string sets;
    std::vector<Value> values;
    for (const auto& [column, cell] : state.row.items()) {
      names.Check(table, column);
      sets += (sets.empty() ? "" : ", ") + column + " = ?";
      values.push_back(ValueOf(cell));
    }
    values.emplace_back(id);
    std::string sql = "UPDATE ";
    past.Run(sql.append(table).append(" SET ").append(sets).append(" WHERE id = ?"), values);
  }
}

void KeepAuditRow(Database& past, const AuditRow& row) {
  past.Run(
      "INSERT INTO audit (" + std::string(detail::kAuditColumns) + ") VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)",
      {ToValue(row.origin), row.sequence, ToValue(row.stamp.now), ToValue(row.stamp.utc_offset_min), row.stamp.zone,
       row.stamp.user, row.stamp.machine, row.software, row.action, row.entity, row.entity_id, row.field,
       ToValue(row.old_value), ToValue(row.new_value), row.reason, ToValue(row.previous_hash), ToValue(row.hash)});
}

/// Two copies may have given the same name or number before they came together: what stands UNIQUE in the study is only
/// looked up quickly here.
void MakeTables(Database& past, Database& now) {
  static const std::regex of_table(R"(,\s*UNIQUE \([^)]*\))"), of_column(R"( UNIQUE\b)");
  std::vector<std::string> migrations;
  for (const std::string& sql : detail::Migrations()) {
    migrations.push_back(std::regex_replace(std::regex_replace(sql, of_table, ""), of_column, ""));
  }
  detail::Migrate(past, migrations);
  for (const std::string& table : detail::AuditedTables(now)) {
    int count = 0;
    for (const detail::UniqueKey& key : detail::UniqueKeysOf(now, table)) {
      std::string columns;
      for (const std::string& column : key.columns) columns += (columns.empty() ? "" : ", ") + column;
      std::string sql = "CREATE INDEX past_";
      sql.append(table).append(std::to_string(++count)).append(" ON ").append(table);
      past.Execute(sql.append(" (").append(columns).append(")"));
    }
  }
}

void MakeEmpty(Database& past, Database& now) {
  MakeTables(past, now);
  // What is replayed was allowed when it happened.
  for (const std::string& name : past.Rows("SELECT name FROM sqlite_master WHERE type = 'trigger'",
                                           [](const RowView& row) { return row.Text(0); })) {
    past.Execute("DROP TRIGGER " + name);
  }
  past.Run("INSERT INTO this_copy (only_row, origin) VALUES (1, ?)",
           {now.One("SELECT origin FROM this_copy", [](const RowView& row) { return row.Text(0); }).value_or("")});
}

}  // namespace

Result<Record> AsOf(Record& record, UtcTime instant) {
  return Guarded([&] {
    Record::Impl& now = Access::Of(record);
    Database past(":memory:", true);
    MakeEmpty(past, now.database);
    Names names(past);
    past.Execute("BEGIN");
    std::int64_t rows = 0;
    // Times are text of one length, so that they compare as they follow each other.
    const std::string sql = "SELECT " + std::string(detail::kAuditColumns) +
                            " FROM audit a WHERE sequence <= (SELECT coalesce(max(sequence), 0) FROM audit l WHERE "
                            "l.origin = a.origin AND l.utc <= ?) "
                            "ORDER BY max(utc) OVER (PARTITION BY origin ORDER BY sequence), origin, sequence";
    now.database.Each(
        sql,
        [&](const RowView& view) {
          const AuditRow row = detail::ReadAuditRow(view);
          Make(past, names, row);
          KeepAuditRow(past, row);
          ++rows;
        },
        instant);
    Settle(past, names);
    past.Execute("COMMIT; PRAGMA query_only=ON");
    if (rows == 0) Refuse(ErrorCode::kNotFound, "there was no study yet at " + instant.ToString());
    return Access::Make(Record::Impl{now.folder, now.objects, std::move(past)});
  });
}

}  // namespace striae::store
