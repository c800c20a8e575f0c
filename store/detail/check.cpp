#include "store/detail/check.h"

#include <map>
#include <set>

#include "store/detail/audit_hash.h"
#include "store/detail/change.h"
#include "store/detail/codec.h"

namespace striae::store::detail {
namespace {

using nlohmann::json;
using Severity = Finding::Severity;

void Add(CheckReport& report, Severity severity, std::string where, std::string what) {
  report.findings.push_back({severity, std::move(where), std::move(what)});
}

std::string NameOf(const AuditRow& row) {
  return "audit row " + std::to_string(row.sequence) + " (" + row.entity + " " + row.entity_id + ")";
}

/// Follows one copy's chain row by row.
struct ChainWalk {
  Sha256 hash;
  std::int64_t sequence = 0;
  UtcTime time{};

  void Step(const AuditRow& row, CheckReport& report) {
    if (row.sequence != sequence + 1) {
      Add(report, Severity::kError, NameOf(row),
          "rows " + std::to_string(sequence + 1) + " to " + std::to_string(row.sequence - 1) +
              " of the audit trail are missing; restore a backup");
    } else if (row.previous_hash != hash) {
      Add(report, Severity::kError, NameOf(row),
          "does not follow on row " + std::to_string(sequence) + "; one of the two was altered; restore a backup");
    }
    if (HashOf(row) != row.hash) {
      Add(report, Severity::kError, NameOf(row), "was altered: its content does not give its hash; restore a backup");
    }
    if (row.stamp.now < time) {
      Add(report, Severity::kWarning, NameOf(row),
          "the clock of " + row.stamp.machine + " was set back: " + row.stamp.now.ToString() + " after " +
              time.ToString() + "; the order is that of the row numbers");
    }
    hash = row.hash;
    sequence = row.sequence;
    time = row.stamp.now;
  }
};

/// Tables whose rows have an audit trail.
constexpr const char* kAudited[] = {"study",   "site",    "subject",     "consent",    "visit",
                                    "object",  "device",  "calibration", "session",    "capture",
                                    "outline", "derived", "outcome",     "measurement"};

using States = std::map<std::string, json>;

/// What the rows of one table must be by the trail.
States StatesByTrail(Database& database, const std::string& table) {
  States states;
  struct Step {
    std::string action, id, field, value;
  };
  const auto steps = database.Rows(
      "SELECT action, entity_id, field, coalesce(new_value, '') FROM audit WHERE entity = ? ORDER BY origin, sequence",
      [](const RowView& row) {
        return Step{row.Text(0), row.Text(1), row.Text(2), row.Text(3)};
      },
      table);
  for (const Step& step : steps) {
    json value = json::parse(step.value, nullptr, false);
    if (step.action == "create") {
      states[step.id] = std::move(value);
    } else if (states[step.id].is_object()) {
      states[step.id][step.field] = std::move(value);
    }
  }
  return states;
}

/// Columns in which a row differs from its trail. A column that a later migration added stands in no older trail row.
std::string Differences(const json& row, const json& by_trail) {
  if (!by_trail.is_object()) return "all columns";
  std::string names;
  for (const auto& [column, value] : row.items()) {
    const auto recorded = by_trail.find(column);
    const bool same = recorded == by_trail.end() ? value.is_null() : Dump(*recorded) == Dump(value);
    if (!same) names += (names.empty() ? "" : ", ") + column;
  }
  return names;
}

void CheckTable(Database& database, const std::string& table, CheckReport& report) {
  States states = StatesByTrail(database, table);
  const auto add = [&](const std::string& id, std::string what) {
    std::string where = table;
    where.append(" ").append(id);
    Add(report, Severity::kError, std::move(where), std::move(what));
  };
  const std::string select_ids = "SELECT id FROM " + table;
  for (const std::string& id : database.Rows(select_ids, [](const RowView& row) { return row.Text(0); })) {
    const auto found = states.find(id);
    if (found == states.end()) {
      add(id, "has no audit row: it was written past the record, or the trail was cut; restore a backup");
      continue;
    }
    const std::string differences = Differences(RowAsJson(database, table, id), found->second);
    if (!differences.empty()) {
      std::string what = "was changed past the audit trail (";
      what.append(differences).append("); see 'striae history ").append(id).append("', restore a backup");
      add(id, std::move(what));
    }
    states.erase(found);
  }
  for (const auto& [id, state] : states) add(id, "is in the audit trail but not in the record; restore a backup");
}

}  // namespace

void CheckDatabase(Database& database, CheckReport& report) {
  for (const std::string& line :
       database.Rows("PRAGMA integrity_check", [](const RowView& row) { return row.Text(0); })) {
    if (line != "ok") Add(report, Severity::kError, "study.db", "SQLite finds: " + line + "; restore a backup");
  }
  for (const std::string& line : database.Rows("PRAGMA foreign_key_check", [](const RowView& row) {
         return "a row of " + row.Text(0) + " points to a " + row.Text(2) + " that is not there";
       })) {
    Add(report, Severity::kError, "study.db", line + "; restore a backup");
  }
}

void CheckChain(Database& database, const std::optional<AuditHead>& expected, CheckReport& report) {
  const std::string own =
      database.One("SELECT origin FROM this_copy", [](const RowView& row) { return row.Text(0); }).value_or("");
  std::map<std::string, ChainWalk> walks;
  bool expected_seen = !expected;
  // Walked row by row: the trail grows with the study, memory does not.
  const auto visit = [&](const RowView& view) {
    const AuditRow row = ReadAuditRow(view);
    walks[row.origin].Step(row, report);
    ++report.audit_rows;
    if (expected && row.origin == own && row.sequence == expected->sequence) {
      expected_seen = true;
      if (row.hash != expected->hash) {
        Add(report, Severity::kError, NameOf(row),
            "is not the row whose hash was noted earlier; the trail was rewritten");
      }
    }
    return true;
  };
  database.Each("SELECT " + std::string(kAuditColumns) + " FROM audit ORDER BY origin, sequence", visit);
  report.head = {walks[own].sequence, walks[own].hash};
  if (!expected_seen) {
    Add(report, Severity::kError, "audit trail",
        "was cut at its end: it has " + std::to_string(walks[own].sequence) + " rows, but row " +
            std::to_string(expected->sequence) + " was noted earlier; restore a backup");
  }
}

void CheckRowsAgainstTrail(Database& database, CheckReport& report) {
  for (const char* table : kAudited) CheckTable(database, table, report);
}

void CheckObjects(Database& database, const ObjectStore& objects, CheckReport& report) {
  std::set<Sha256> known;
  for (const Sha256& sha256 :
       database.Rows("SELECT id FROM object ORDER BY id", [](const RowView& row) { return row.Hash(0); })) {
    known.insert(sha256);
    ++report.objects;
    if (const Status sound = objects.Verify(sha256); !sound) {
      Add(report, Severity::kError, "object " + sha256.ToString(), sound.error().message);
    }
  }
  const auto listing = Unwrap(objects.List());
  for (const Sha256& sha256 : listing.objects) {
    if (known.contains(sha256)) continue;
    Add(report, Severity::kWarning, "object " + sha256.ToString(),
        "is in no row: left by a program that was stopped before it had finished; importing the file again puts it "
        "right");
  }
  for (const auto& path : listing.strangers) {
    Add(report, Severity::kWarning, path.filename().string(),
        "in objects/ is not an object: an unfinished copy, or put there by hand; it can be removed");
  }
}

}  // namespace striae::store::detail
