#include "store/detail/scope.h"

#include <array>
#include <utility>

#include <nlohmann/json.hpp>
#include <sodium.h>

#include "store/detail/change.h"
#include "store/detail/codec.h"

namespace striae::store::detail {
namespace {

/// Conditions on ?1, the target's id, that pick the subjects, visits, sessions and captures within a target.
struct Scope {
  std::string subjects, visits, sessions, captures;
};

Scope ScopeOf(const std::string& entity) {
  const std::string nothing = "?1 IS NULL";
  if (entity == "study") return {"?1 = ?1", "?1 = ?1", "?1 = ?1", "?1 = ?1"};
  if (entity == "subject") {
    return {"id = ?1", "subject_id = ?1", "subject_id = ?1",
            "session_id IN (SELECT id FROM session WHERE subject_id = ?1)"};
  }
  if (entity == "visit") {
    return {nothing, "id = ?1", "visit_id = ?1", "session_id IN (SELECT id FROM session WHERE visit_id = ?1)"};
  }
  if (entity == "session") return {nothing, nothing, "id = ?1", "session_id = ?1"};
  if (entity == "capture") return {nothing, nothing, nothing, "id = ?1"};
  Refuse(ErrorCode::kUsage, "a study, subject, visit, session or capture is signed or locked, not a " + entity);
}

std::string Within(const std::string& table, const std::string& condition) {
  return "SELECT id FROM " + table + " WHERE " + condition;
}

/// Each table with the query for its rows, in the order in which they are hashed.
std::vector<std::pair<std::string, std::string>> Tables(const std::string& entity) {
  const Scope scope = ScopeOf(entity);
  const std::string subjects = "subject_id IN (" + Within("subject", scope.subjects) + ")";
  const std::string captures = "capture_id IN (" + Within("capture", scope.captures) + ")";
  std::vector<std::pair<std::string, std::string>> tables = {
      {"subject", scope.subjects},
      {"consent", subjects},
      {"treatment", subjects},
      {"arm_assignment", subjects},
      {"visit", scope.visits},
      {"session", scope.sessions},
      {"capture", scope.captures},
      {"outline", captures},
      {"derived", captures},
      {"outcome", captures},
      {"measurement", "outcome_id IN (SELECT id FROM outcome WHERE " + captures + ")"},
      {"exclusion", captures}};
  if (entity == "study") {
    for (const char* whole : {"study", "site", "arm", "planned_visit", "device", "calibration"}) {
      tables.emplace_back(whole, "?1 = ?1");
    }
  }
  return tables;
}

}  // namespace

std::set<std::string> EntitiesWithin(Database& database, const Record::Found& target) {
  const Scope scope = ScopeOf(target.entity);
  std::set<std::string> ids = {target.id};
  for (const auto& [table, condition] : {std::pair<std::string, std::string>{"subject", scope.subjects},
                                         {"visit", scope.visits},
                                         {"session", scope.sessions},
                                         {"capture", scope.captures}}) {
    database.Each(
        Within(table, condition), [&](const RowView& row) { ids.insert(row.Text(0)); }, target.id);
  }
  return ids;
}

Sha256 ContentHash(Database& database, const Record::Found& target) {
  if (sodium_init() < 0) Refuse(ErrorCode::kInternal, "libsodium could not start");
  crypto_hash_sha256_state state;
  crypto_hash_sha256_init(&state);
  for (const auto& [table, condition] : Tables(target.entity)) {
    const auto ids = database.Rows(
        Within(table, condition) + " ORDER BY id", [](const RowView& row) { return row.Text(0); }, target.id);
    for (const std::string& id : ids) {
      nlohmann::json row = RowAsJson(database, table, id);
      for (auto entry = row.begin(); entry != row.end();) {
        entry = entry->is_null() ? row.erase(entry) : std::next(entry);
      }
      const std::string line = table + " " + Dump(row) + "\n";
      crypto_hash_sha256_update(&state, reinterpret_cast<const unsigned char*>(line.data()), line.size());
    }
  }
  Sha256 hash;
  crypto_hash_sha256_final(&state, hash.bytes.data());
  return hash;
}

}  // namespace striae::store::detail
