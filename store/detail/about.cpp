#include "store/detail/about.h"

#include <algorithm>
#include <array>

#include "store/detail/impl.h"
#include "store/detail/schema.h"
#include "store/json.h"

namespace striae::store::detail {
namespace {

using nlohmann::json;

template <typename T>
void Put(json& object, const char* name, const std::vector<T>& entries) {
  if (entries.empty()) return;
  object[name] = json::array();
  for (const T& entry : entries) object[name].push_back(ToJson(entry));
}

void PutLocks(Record& record, const Record::Found& found, json& object) {
  std::vector<Lock> own = Unwrap(Locks(record));
  std::erase_if(own, [&](const Lock& lock) { return lock.target.id != found.id && lock.id.ToString() != found.id; });
  Put(object, "locks", own);
}

void PutExclusions(Record& record, const Record::Found& found, json& object) {
  if (found.entity == "capture") {
    Put(object, "exclusions", Unwrap(Exclusions(record, Unwrap(CaptureId::Parse(found.id)))));
    return;
  }
  if (found.entity != "measurement") return;
  const auto reason = Access::Of(record).database.One(
      "SELECT group_concat(x.reason, '; ') FROM measurement m JOIN outcome o ON o.id = m.outcome_id JOIN exclusion_now "
      "x ON x.capture_id = o.capture_id AND (x.analysis IS NULL OR (x.analysis = o.analysis AND x.name = m.name)) "
      "WHERE m.id = ?",
      [](const RowView& row) { return row.OptionalText(0); }, found.id);
  if (reason && *reason) object["excluded"] = **reason;
}

void PutCourse(Record& record, const Record::Found& found, json& object) {
  const SubjectId subject = Unwrap(SubjectId::Parse(found.id));
  if (const auto arm = Unwrap(ArmOf(record, subject))) object["arm"] = arm->name;
  Put(object, "treatments", Unwrap(Treatments(record, subject)));
}

/// Tables whose description leads on by itself.
constexpr std::array kDescribed = {"subject", "session", "capture", "outcome", "measurement", "visit", "object"};

void PutReferences(Record& record, const Record::Found& found, json& object) {
  if (std::find(kDescribed.begin(), kDescribed.end(), found.entity) != kDescribed.end()) return;
  Database& database = Access::Of(record).database;
  for (const std::string& table : AuditedTables(database)) {
    const auto columns = database.Rows(R"(SELECT "from" FROM pragma_foreign_key_list(?) WHERE "table" = ?)",
                                       [](const RowView& row) { return row.Text(0); }, table, found.entity);
    for (const std::string& column : columns) {
      std::string sql = "SELECT id FROM ";
      sql.append(table).append(" WHERE ").append(column).append(" = ? ORDER BY id");
      const auto ids = database.Rows(
          sql, [](const RowView& row) { return row.Text(0); }, found.id);
      if (!ids.empty()) object["referenced_by"][table] = ids;
    }
  }
}

}  // namespace

json About(Record& record, const Record::Found& found) {
  json object = json::object();
  Put(object, "notes", Unwrap(Notes(record, found.id)));
  Put(object, "queries", Unwrap(Queries(record, true, found.id)));
  Put(object, "signatures", Unwrap(Signatures(record, found.id)));
  Put(object, "reassignments", Unwrap(Reassignments(record, found.id)));
  PutLocks(record, found, object);
  PutExclusions(record, found, object);
  if (found.entity == "subject") PutCourse(record, found, object);
  PutReferences(record, found, object);
  return object;
}

}  // namespace striae::store::detail
