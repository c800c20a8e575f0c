#include "store/detail/change.h"

#include "core/provenance.h"
#include "store/detail/audit_hash.h"

namespace striae::store::detail {
namespace {

using nlohmann::json;

json ToJson(const Value& value) {
  return std::visit(
      [](const auto& plain) -> json {
        if constexpr (std::is_same_v<std::decay_t<decltype(plain)>, std::monostate>) {
          return nullptr;
        } else {
          return plain;
        }
      },
      value);
}

}  // namespace

json RowAsJson(Database& database, const std::string& table, const std::string& id) {
  const auto read = [](const RowView& row) {
    json object = json::object();
    for (int column = 0; column < row.size(); ++column) object[row.NameOf(column)] = ToJson(row.ValueOf(column));
    return object;
  };
  return database.One("SELECT * FROM " + table + " WHERE id = ?", read, id).value_or(json());
}

Change::Change(Database& database, const Stamp& stamp) : database_(database), stamp_(stamp) {
  stamp_.user = CleanText(stamp_.user);
  stamp_.machine = CleanText(stamp_.machine);
  stamp_.zone = CleanText(stamp_.zone);
  if (stamp_.user.empty()) {
    Refuse(ErrorCode::kUsage, "who does this is not known; set STRIAE_USER to your user name");
  }
  database_.Execute("BEGIN IMMEDIATE");
}

Change::~Change() {
  if (!open_) return;
  try {
    database_.Execute("ROLLBACK");
  } catch (...) {
    // SQLite has rolled back by itself (disk full); the error that led here is being reported already.
    open_ = false;
  }
}

void Change::Insert(const std::string& table, const Columns& columns, const std::string& reason) {
  std::string names, marks;
  std::vector<Value> values;
  for (const auto& [name, value] : columns) {
    names += (names.empty() ? "" : ", ") + std::string(name);
    marks += marks.empty() ? "?" : ", ?";
    values.push_back(value);
  }
  database_.Run("INSERT INTO " + table + " (" + names + ") VALUES (" + marks + ")", values);
  AuditRow row;
  row.action = "create";
  row.entity = table;
  row.entity_id = std::get<std::string>(columns.front().second);
  row.new_value = RowAsJson(database_, table, row.entity_id).dump();
  row.reason = CleanText(reason);
  Audit(std::move(row));
}

void Change::Set(const std::string& table, const std::string& id, const std::string& column, const Value& value,
                 const std::string& reason) {
  const json before = RowAsJson(database_, table, id);
  if (before.is_null()) throw std::logic_error("Change::Set: no such row in " + table);
  const json after = ToJson(value);
  if (before.at(column) == after) return;
  database_.Run("UPDATE " + table + " SET " + column + " = ? WHERE id = ?", {value, id});
  AuditRow row;
  row.action = "change";
  row.entity = table;
  row.entity_id = id;
  row.field = column;
  row.old_value = before.at(column).dump();
  row.new_value = after.dump();
  row.reason = CleanText(reason);
  Audit(std::move(row));
}

void Change::Account(const std::string& table, const std::string& id, const std::string& column, const json& before,
                     const json& after, const std::string& reason) {
  AuditRow row;
  row.action = "change";
  row.entity = table;
  row.entity_id = id;
  row.field = column;
  row.old_value = before.dump();
  row.new_value = after.dump();
  row.reason = CleanText(reason);
  Audit(std::move(row));
}

void Change::Note(const std::string& what, const std::string& field, const std::string& before,
                  const std::string& after) {
  AuditRow row;
  row.action = "note";
  row.entity = what;
  row.entity_id = what;
  row.field = field;
  row.old_value = before;
  row.new_value = after;
  Audit(std::move(row));
}

void Change::Audit(AuditRow row) {
  row.stamp = stamp_;
  row.software = "striae " + std::string(StriaeVersion());
  const auto origin = database_.One("SELECT origin FROM this_copy", [](const RowView& r) { return r.Text(0); });
  if (!origin) Refuse(ErrorCode::kRecordDamaged, "study.db does not say which copy it is; restore a backup");
  row.origin = *origin;
  struct Last {
    std::int64_t sequence = 0;
    Sha256 hash;
  };
  const auto last = database_
                        .One(
                            "SELECT sequence, hash FROM audit WHERE origin = ? ORDER BY sequence DESC LIMIT 1",
                            [](const RowView& r) {
                              return Last{r.Integer(0), r.Hash(1)};
                            },
                            row.origin)
                        .value_or(Last{});
  row.sequence = last.sequence + 1;
  row.previous_hash = last.hash;
  row.hash = HashOf(row);
  database_.Run(
      "INSERT INTO audit (" + std::string(kAuditColumns) + ") VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)",
      {ToValue(row.origin), row.sequence, ToValue(row.stamp.now), ToValue(row.stamp.utc_offset_min), row.stamp.zone,
       row.stamp.user, row.stamp.machine, row.software, row.action, row.entity, row.entity_id, row.field,
       ToValue(row.old_value), ToValue(row.new_value), row.reason, ToValue(row.previous_hash), ToValue(row.hash)});
}

void Change::Commit() {
  database_.Execute("COMMIT");
  open_ = false;
}

}  // namespace striae::store::detail
