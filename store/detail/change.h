// A change of the record: one transaction that writes rows and their audit rows together.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "store/audit.h"
#include "store/detail/database.h"

namespace striae::store::detail {

using Columns = std::vector<std::pair<const char*, Value>>;

/// A whole row as JSON, columns in alphabetical order; null when there is no such row.
nlohmann::json RowAsJson(Database& database, const std::string& table, const std::string& id);

/// Takes the write lock when made; rolls back unless committed. Rules are asked after it is made, so that no other
/// program can change the answer in between.
class Change {
 public:
  Change(Database& database, const Stamp& stamp);
  ~Change();
  Change(const Change&) = delete;
  Change& operator=(const Change&) = delete;

  /// A new row; the audit row holds all of it. `columns` begins with id.
  void Insert(const std::string& table, const Columns& columns, const std::string& reason = "");
  /// A new value of one column; nothing happens when it has that value already.
  void Set(const std::string& table, const std::string& id, const std::string& column, const Value& value,
           const std::string& reason);
  /// The audit row of a change that was made otherwise (a merge, which must step over its own provisional values).
  void Account(const std::string& table, const std::string& id, const std::string& column, const nlohmann::json& before,
               const nlohmann::json& after, const std::string& reason);
  /// An audit row for what is no row of a table (the file's own format).
  void Note(const std::string& what, const std::string& field, const std::string& before, const std::string& after);
  void Commit();

 private:
  void Audit(AuditRow row);

  Database& database_;
  Stamp stamp_;
  bool open_ = true;
};

}  // namespace striae::store::detail
