// SQLite's structure, the tables and guards of this format, and what lies beside the record.
#include <algorithm>
#include <set>
#include <tuple>

#include "store/detail/check.h"
#include "store/detail/disk.h"
#include "store/detail/schema.h"
#include "store/identity.h"

namespace striae::store::detail {

namespace fs = std::filesystem;

void Findings::Add(Finding::Severity severity, const std::string& where, std::string what) {
  const std::string kind = where.substr(0, where.find(' '));
  if (++counts_[kind] <= kMostFindings || severity == Finding::Severity::kError) {
    if (counts_[kind] <= 2 * kMostFindings) report_.findings.push_back({severity, where, std::move(what)});
  }
}

void Findings::Close() {
  for (const auto& [kind, count] : counts_) {
    if (count <= kMostFindings) continue;
    report_.findings.push_back({Finding::Severity::kError, kind,
                                std::to_string(count) + " findings of this kind in all; not all of them are named"});
  }
}

void CheckDatabase(Database& database, Findings& findings) {
  database.Each("PRAGMA integrity_check", [&](const RowView& row) {
    std::string line = row.Text(0);
    if (line == "ok") return;
    std::replace(line.begin(), line.end(), '\n', ' ');
    findings.Error("study.db", "SQLite finds: " + line + "; keep this copy as it is and restore a backup");
  });
  database.Each("PRAGMA foreign_key_check", [&](const RowView& row) {
    findings.Error("study.db",
                   "a row of " + row.Text(0) + " points to a " + row.Text(2) + " that is not there; restore a backup");
  });
}

void CheckSchema(Database& database, Findings& findings) {
  if (database.UserVersion() != static_cast<std::int64_t>(Migrations().size())) return;
  using Part = std::tuple<std::string, std::string, std::string>;
  const auto parts = [](Database& from) {
    std::set<Part> all;
    from.Each("SELECT type, name, coalesce(sql, '') FROM sqlite_master WHERE name NOT LIKE 'sqlite_stat%'",
              [&](const RowView& row) { all.emplace(row.Text(0), row.Text(1), row.Text(2)); });
    return all;
  };
  Database fresh(":memory:", true);
  Migrate(fresh, Migrations());
  const std::set<Part> expected = parts(fresh), found = parts(database);
  for (const auto& part : expected) {
    if (found.contains(part)) continue;
    findings.Error("study.db", "its " + std::get<0>(part) + " " + std::get<1>(part) +
                                   " was removed or changed past the record; restore a backup");
  }
  for (const auto& part : found) {
    const bool known = std::any_of(expected.begin(), expected.end(),
                                   [&](const Part& other) { return std::get<1>(other) == std::get<1>(part); });
    if (!known) {
      findings.Warning("study.db", "a " + std::get<0>(part) + " " + std::get<1>(part) +
                                       " that is not Striae's was added; ask who did it");
    }
  }
}

std::vector<fs::path> Leftovers(const fs::path& study) {
  std::vector<fs::path> left;
  for (const fs::path& folder : {study, study / "quarantine"}) {
    std::error_code absent;
    for (const auto& entry : fs::directory_iterator(folder, absent)) {
      const std::string name = entry.path().filename().string();
      const bool unfinished = name.starts_with(".study.db.new") || name.starts_with(".part-") ||
                              name.ends_with(".part") || name.find(".part-") != std::string::npos;
      if (unfinished && entry.is_regular_file()) left.push_back(entry.path());
    }
  }
  std::sort(left.begin(), left.end());
  return left;
}

void CheckIdentities(Database& database, const fs::path& study, Findings& findings) {
  const fs::path file = study / kIdentityName;
  if (!fs::exists(file)) return;
  if (const Status whole = CheckIdentityFile(file); !whole) {
    findings.Error(kIdentityName, whole.error().message);
    return;
  }
  // Not only the last: its row is written before the file gets its name, and a kill can come between.
  constexpr const char* kNoted = "SELECT count(*) FROM audit WHERE entity_id = ?1 AND (?2 IS NULL OR new_value = ?2)";
  const std::optional<std::string> any, digest = HashFile(file).ToString();
  if (database.Count(kNoted, kIdentityName, any) != 0 && database.Count(kNoted, kIdentityName, digest) == 0) {
    findings.Warning(kIdentityName,
                     "is whole, but none that the trail knows: it was put here past the record; ask who did it");
  }
}

void CheckLeftovers(const fs::path& study, Findings& findings) {
  for (const fs::path& path : Leftovers(study)) {
    findings.Warning(path.lexically_relative(study).string(),
                     "is unfinished: left by a program that was stopped; 'striae check --repair' settles it");
  }
}

}  // namespace striae::store::detail
