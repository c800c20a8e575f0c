// From what a person types to the entity that it names.
#include <algorithm>

#include "store/detail/read.h"
#include "store/detail/schema.h"
#include "store/detail/words.h"

namespace striae::store {
namespace {

constexpr std::size_t kShortestPrefix = 8;  // 32 bits: two of 10,000 captures share it once in a hundred studies

bool IsIdText(std::string_view text) {
  return text.size() >= kShortestPrefix && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || c == '-';
         });
}

void Append(std::vector<Record::Found>& all, Database& database, const std::string& entity, const std::string& where,
            const std::string& name) {
  std::string sql = "SELECT id FROM ";
  sql.append(entity).append(" WHERE ").append(where).append(" LIMIT 3");
  for (const std::string& id : database.Rows(
           sql, [](const RowView& row) { return row.Text(0); }, name)) {
    all.push_back({entity, id});
  }
}

}  // namespace

Result<Record::Found> Record::Find(std::string_view name) {
  return Guarded([&] {
    Database& database = impl_->database;
    const std::string text(name);
    std::vector<Found> all;
    Append(all, database, "subject", "pseudonym = ?", text);
    if (all.empty()) Append(all, database, "device", "serial = ?", text);
    if (all.empty() && IsIdText(text)) {
      // Hexadecimal digits and '-' only, so that nothing in it means anything to GLOB.
      for (const std::string& table : detail::AuditedTables(database))
        Append(all, database, table, "id GLOB ?", text + "*");
      if (all.empty()) Append(all, database, "derived", "sha256 GLOB ?", text + "*");
    }
    if (all.empty()) {
      Refuse(ErrorCode::kNotFound, "nothing in this study is called '" + text.substr(0, 70) +
                                       "'; give a pseudonym, a device's serial, or an id (at least its first " +
                                       std::to_string(kShortestPrefix) + " characters)");
    }
    if (all.size() > 1) {
      std::string list;
      for (const Found& found : all) list += " " + found.entity + " " + found.id + ";";
      Refuse(ErrorCode::kUsage,
             "'" + text.substr(0, 70) + "' can mean several things:" + list + " give more of its id");
    }
    return all.front();
  });
}

}  // namespace striae::store
