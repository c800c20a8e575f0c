// The trail's chains, and the rows of the record against them.
#include "store/detail/check.h"

#include <algorithm>
#include <set>

#include "store/detail/audit_hash.h"
#include "store/detail/change.h"
#include "store/detail/codec.h"
#include "store/detail/schema.h"
#include "store/detail/trail.h"

namespace striae::store::detail {
namespace {

using nlohmann::json;

std::string NameOf(const AuditRow& row) {
  std::string name = "audit row " + std::to_string(row.sequence);
  return name.append(" (").append(row.entity).append(" ").append(row.entity_id).append(")");
}

/// Follows one copy's chain row by row.
struct ChainWalk {
  Sha256 hash;
  std::int64_t sequence = 0;
  UtcTime time{};
  bool unreadable = false;  ///< the last row could not be read, so the next cannot be held against it

  void Step(const AuditRow& row, Findings& findings) {
    if (row.sequence != sequence + 1) {
      findings.Error(NameOf(row), "rows " + std::to_string(sequence + 1) + " to " + std::to_string(row.sequence - 1) +
                                      " of the audit trail are missing; restore a backup");
    } else if (row.previous_hash != hash && !unreadable) {
      findings.Error(NameOf(row), "does not follow on row " + std::to_string(sequence) +
                                      "; one of the two was altered; restore a backup");
    }
    if (HashOf(row) != row.hash) {
      findings.Error(NameOf(row), "was altered: its content does not give its hash; restore a backup");
    }
    if (row.stamp.now < time) {
      findings.Warning(NameOf(row), "the clock of " + row.stamp.machine + " was set back: " + row.stamp.now.ToString() +
                                        " after " + time.ToString() + "; the order is that of the row numbers");
    }
    hash = row.hash;
    sequence = row.sequence;
    time = row.stamp.now;
    unreadable = false;
  }
};

/// The heads that were noted outside the study.
class Noted {
 public:
  Noted(const std::vector<AuditHead>& heads, const std::string& own) : heads_(heads) {
    for (AuditHead& head : heads_) {
      if (head.origin.empty()) head.origin = own;
    }
  }
  void Pass(const AuditRow& row, Findings& findings) const {
    for (const AuditHead& head : heads_) {
      if (head.origin != row.origin || head.sequence != row.sequence || head.hash == row.hash) continue;
      findings.Error(NameOf(row), "is not the row whose hash was noted earlier; the trail was rewritten");
    }
  }
  void End(std::map<std::string, ChainWalk>& walks, Findings& findings) const {
    for (const AuditHead& head : heads_) {
      if (walks[head.origin].sequence >= head.sequence) continue;
      findings.Error("audit trail", "was cut at its end: it has " + std::to_string(walks[head.origin].sequence) +
                                        " rows of copy " + head.origin + ", but row " + std::to_string(head.sequence) +
                                        " was noted earlier; restore a backup");
    }
  }

 private:
  std::vector<AuditHead> heads_;
};

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

class TableCheck {
 public:
  TableCheck(Database& database, std::string table, const Knowledge& knowledge, Findings& findings)
      : database_(database), table_(std::move(table)), knowledge_(knowledge), findings_(findings) {}

  /// All steps of the table, those of one entity after each other.
  void Pass(const std::string& id, Step step) {
    if (id != id_) End();
    id_ = id;
    steps_.push_back(std::move(step));
  }
  void End() {
    if (!steps_.empty()) Compare(StateOf(std::move(steps_), knowledge_));
    steps_.clear();
  }

 private:
  void Error(const std::string& what) { findings_.Error(table_ + " " + id_, what); }
  void Compare(const TrailState& state) {
    const json row = RowAsJson(database_, table_, id_);
    if (row.is_null()) {
      Error("is in the audit trail but not in the record; restore a backup");
    } else if (state.row.is_null()) {
      Error("has no audit row for its making; restore a backup");
    } else if (const std::string differences = Differences(row, state.row); !differences.empty()) {
      Error("was changed past the audit trail (" + differences + "); see 'striae history " + id_ +
            "', restore a backup");
    }
  }

  Database& database_;
  std::string table_;
  const Knowledge& knowledge_;
  Findings& findings_;
  std::string id_;
  std::vector<Step> steps_;
};

void CheckTable(Database& database, const std::string& table, const Knowledge& knowledge, Findings& findings) {
  TableCheck check(database, table, knowledge, findings);
  database.Each(
      std::string(kSteps) +
          ", entity_id FROM audit WHERE entity = ? AND action IN ('create', 'change') ORDER BY entity_id",
      [&](const RowView& row) { check.Pass(row.Text(6), ReadStep(row)); }, table);
  check.End();
  std::string without = "SELECT id FROM " + table;
  without += " t WHERE NOT EXISTS (SELECT 1 FROM audit a WHERE a.entity = ? AND a.entity_id = t.id)";
  database.Each(
      without,
      [&](const RowView& row) {
        findings.Error(table + " " + row.Text(0),
                       "has no audit row: it was written past the record, or the trail was cut; restore a backup");
      },
      table);
}

}  // namespace

void CheckChain(Database& database, const CheckOptions& options, Findings& findings) {
  const std::string own =
      database.One("SELECT origin FROM this_copy", [](const RowView& row) { return row.Text(0); }).value_or("");
  const Noted noted(options.expected, own);
  std::map<std::string, ChainWalk> walks;
  const auto all = static_cast<std::size_t>(database.Count("SELECT count(*) FROM audit"));
  constexpr std::int64_t kEvery = 1000;
  // Walked row by row: the trail grows with the study, memory does not.
  const auto visit = [&](const RowView& view) {
    if (options.progress && ++findings.report().audit_rows % kEvery == 0) {
      options.progress(static_cast<std::size_t>(findings.report().audit_rows), all, "audit rows");
    } else if (!options.progress) {
      ++findings.report().audit_rows;
    }
    const auto row = Guarded([&] { return ReadAuditRow(view); });
    if (row) {
      walks[row->origin].Step(*row, findings);
      noted.Pass(*row, findings);
      return;
    }
    ChainWalk& walk = walks[view.Text(0)];
    walk.sequence = view.Integer(1);
    walk.unreadable = true;
    findings.Error("audit row " + std::to_string(walk.sequence),
                   "was altered: it cannot be read (" + row.error().message + "); restore a backup");
  };
  database.Each("SELECT " + std::string(kAuditColumns) + " FROM audit ORDER BY origin, sequence", visit);
  for (const auto& [origin, walk] : walks) findings.report().heads.push_back({walk.sequence, walk.hash, origin});
  findings.report().head = {walks[own].sequence, walks[own].hash, ""};
  noted.End(walks, findings);
}

void CheckRowsAgainstTrail(Database& database, const Progress& progress, Findings& findings) {
  const Knowledge knowledge(database);
  const auto tables = AuditedTables(database);
  std::size_t done = 0;
  for (const std::string& table : tables) {
    // One damaged table does not hide the others.
    if (const auto checked = Guarded([&] { CheckTable(database, table, knowledge, findings); }); !checked) {
      findings.Error("table " + table, "cannot be read whole: " + checked.error().message);
    }
    if (progress) progress(++done, tables.size(), "tables");
  }
  database.Each("SELECT entity, min(sequence) FROM audit WHERE action IN ('create', 'change') GROUP BY entity",
                [&](const RowView& row) {
                  if (std::find(tables.begin(), tables.end(), row.Text(0)) != tables.end()) return;
                  findings.Error("table " + row.Text(0), "is not in the record, but audit row " +
                                                             std::to_string(row.Integer(1)) +
                                                             " speaks of it; restore a backup");
                });
}

}  // namespace striae::store::detail
