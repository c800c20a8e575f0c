// Rows of another copy, put where they belong; see store/merge.h.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "store/detail/change.h"
#include "store/detail/trail.h"
#include "store/merge.h"

namespace striae::store::detail {

/// A unique index of a table other than its id.
struct UniqueKey {
  std::vector<std::string> columns;
  [[nodiscard]] bool Has(const std::string& column) const;
};
std::vector<UniqueKey> UniqueKeysOf(Database& database, const std::string& table);

/// Within one transaction in which no guard stands and the trails are united already.
class RowMerger {
 public:
  RowMerger(Database& database, Change& change, MergeReport& report);
  /// The row `id` of `table` as the united trail says it, inserted or brought up to date, and its clashes as queries.
  void Place(const std::string& table, const std::string& id);
  /// Numbers within a parent and chains of supersedes, once every row is there.
  void Settle();

 private:
  using Row = nlohmann::json;
  void Write(const std::string& table, const Row& row, bool is_new);
  void MakeRoom(const std::string& table, Row& row);
  void Meet(const std::string& table, const UniqueKey& key, Row& row, const std::string& other_id);
  void Rename(const std::string& table, const UniqueKey& key, Row& row, const std::string& other_id);
  void MoveDuplicate(Row& row, const std::string& other_id);
  void Renumber(const std::string& table, const std::string& parent_column, const std::string& parent);
  void Relink(const std::string& table);
  void Query(const std::string& entity, const std::string& id, const std::string& key, const std::string& text,
             const std::string& at);
  [[nodiscard]] bool IsLater(const std::string& table, const std::string& a, const std::string& b);
  [[nodiscard]] Row Current(const std::string& table, const std::string& id);

  Database& database_;
  Change& change_;
  MergeReport& report_;
  Knowledge knowledge_;
  std::map<std::string, std::vector<UniqueKey>> keys_;
  std::set<std::pair<std::string, std::pair<std::string, std::string>>> renumber_;  ///< table, parent column, parent
  std::set<std::string> relink_;                                                    ///< tables
  std::map<std::string, std::int64_t> original_number_;                             ///< of rows with a provisional one
};

}  // namespace striae::store::detail
