#include "store/merge.h"

#include <algorithm>
#include <map>
#include <set>

#include "store/detail/audit_hash.h"
#include "store/detail/check.h"
#include "store/detail/merge_rows.h"
#include "store/detail/schema.h"
#include "store/detail/words.h"

namespace striae::store {
namespace {

using detail::AuditedTables;

std::string TextAt(const RowView& row) { return row.Text(0); }

/// Nothing that is damaged is carried on.
void RefuseUnlessSound(Record::Impl& study) {
  CheckReport report;
  detail::Findings findings(report);
  detail::CheckChain(study.database, {}, findings);
  detail::CheckRowsAgainstTrail(study.database, {}, findings);
  for (const Finding& finding : report.findings) {
    if (finding.severity != Finding::Severity::kError) continue;
    Refuse(ErrorCode::kRecordDamaged, study.folder.string() + " does not pass its check: " + finding.where + " " +
                                          finding.what + "; nothing was merged");
  }
}

void RefuseOtherStudy(Database& mine, Database& theirs) {
  constexpr const char* kStudy = "SELECT id FROM study";
  if (mine.One(kStudy, TextAt) != theirs.One(kStudy, TextAt)) {
    Refuse(ErrorCode::kRecordRefused,
           "these are two studies, not two copies of one; a copy for another site is made with 'striae restore "
           "STUDY COPY --branch'");
  }
}

std::int64_t LengthOf(Database& database, const std::string& origin) {
  return database.Count("SELECT coalesce(max(sequence), 0) FROM audit WHERE origin = ?", origin);
}

/// Every chain that both have must be one chain; returns how long this copy's is of each origin of the other.
std::map<std::string, std::int64_t> CompareChains(Database& mine, Database& theirs) {
  constexpr const char* kHash = "SELECT hash FROM audit WHERE origin = ? AND sequence = ?";
  std::map<std::string, std::int64_t> lengths;
  for (const std::string& origin : theirs.Rows("SELECT DISTINCT origin FROM audit", TextAt)) {
    const std::int64_t length = LengthOf(mine, origin);
    const std::int64_t common = std::min(length, LengthOf(theirs, origin));
    if (common > 0 && mine.One(kHash, TextAt, origin, common) != theirs.One(kHash, TextAt, origin, common)) {
      Refuse(ErrorCode::kRecordRefused, "both copies wrote on as copy " + origin +
                                            ", as if one folder had been copied by hand; such copies cannot be "
                                            "merged, make them with 'striae restore STUDY COPY --branch'");
    }
    lengths[origin] = length;
  }
  return lengths;
}

void CopyObjects(Record::Impl& into, Record::Impl& other, const Progress& progress, MergeReport& report) {
  const auto all = static_cast<std::size_t>(other.database.Count("SELECT count(*) FROM object"));
  std::size_t done = 0;
  other.database.Each("SELECT id FROM object ORDER BY id", [&](const RowView& row) {
    const Sha256 sha256 = row.Hash(0);
    if (progress) progress(++done, all, "objects");
    if (into.objects.Has(sha256)) return;
    Unwrap(into.objects.PutFile(other.objects.PathOf(sha256), sha256));
    ++report.objects;
  });
}

using Entities = std::set<std::pair<std::string, std::string>>;

/// The other copy's rows of the trail that are not here yet; the entities they speak of.
Entities TakeTrails(Database& mine, Database& theirs, const std::map<std::string, std::int64_t>& lengths,
                    MergeReport& report) {
  Entities entities;
  std::string marks = "?";
  for (int i = 1; i < 17; ++i) marks += ",?";
  const std::string insert = "INSERT INTO audit (" + std::string(detail::kAuditColumns) + ") VALUES (" + marks + ")";
  for (const auto& [origin, length] : lengths) {
    theirs.Each(
        "SELECT " + std::string(detail::kAuditColumns) +
            " FROM audit WHERE origin = ? AND sequence > ? ORDER BY "
            "sequence",
        [&](const RowView& row) {
          std::vector<detail::Value> values;
          values.reserve(static_cast<std::size_t>(row.size()));
          for (int column = 0; column < row.size(); ++column) values.push_back(row.ValueOf(column));
          mine.Run(insert, values);
          ++report.audit_rows;
          if (row.Text(8) != "note") entities.emplace(row.Text(9), row.Text(10));
        },
        origin, length);
  }
  return entities;
}

/// What proves passphrases is kept beside the trail.
void TakeVerifiers(Database& mine, Database& theirs) {
  theirs.Each("SELECT credential_id, text FROM verifier", [&](const RowView& row) {
    mine.Run("INSERT OR IGNORE INTO verifier (credential_id, text) VALUES (?, ?)", {row.Text(0), row.Text(1)});
  });
}

/// What this copy knows of the others from here on.
void NoteHeads(Database& database, Change& change) {
  nlohmann::json heads = nlohmann::json::object();
  database.Each(
      "SELECT origin, max(sequence) FROM audit WHERE origin <> (SELECT origin FROM this_copy) GROUP BY origin",
      [&](const RowView& row) { heads[row.Text(0)] = row.Integer(1); });
  change.Note("merge", "heads", "", heads.dump());
}

/// Takes the guards away for the length of the transaction: what was rightly written at the other copy before a lock,
/// or under a number that both gave, must still find its place. They are put back as they were before it commits.
class WithoutGuards {
 public:
  explicit WithoutGuards(Database& database)
      : database_(database),
        guards_(database.Rows(
            "SELECT sql FROM sqlite_master WHERE type = 'trigger' AND tbl_name <> 'audit' ORDER BY rowid", TextAt)) {
    for (const std::string& name :
         database_.Rows("SELECT name FROM sqlite_master WHERE type = 'trigger' AND tbl_name <> 'audit'", TextAt)) {
      database_.Execute("DROP TRIGGER " + name);
    }
  }
  void PutBack() {
    for (const std::string& guard : guards_) database_.Execute(guard);
  }

 private:
  Database& database_;
  std::vector<std::string> guards_;
};

void TakeRows(Record::Impl& into, Record::Impl& other, const Stamp& stamp, const Progress& progress,
              MergeReport& report) {
  Database& mine = into.database;
  Change change(mine, stamp);  // undone unless committed, guards included
  const auto lengths = CompareChains(mine, other.database);
  mine.Execute("PRAGMA defer_foreign_keys=ON");
  const Entities entities = TakeTrails(mine, other.database, lengths, report);
  if (report.audit_rows == 0) return;
  if (!entities.empty()) {
    WithoutGuards guards(mine);
    NoteHeads(mine, change);
    const auto tables = AuditedTables(mine);
    detail::RowMerger rows(mine, change, report);
    std::size_t done = 0;
    for (const auto& [table, id] : entities) {
      if (std::find(tables.begin(), tables.end(), table) != tables.end()) rows.Place(table, id);
      if (progress) progress(++done, entities.size(), "rows");
    }
    TakeVerifiers(mine, other.database);
    rows.Settle();
    guards.PutBack();
  }
  change.Commit();
}

bool IsOlder(const std::filesystem::path& file) {
  Database database(file, false);
  const auto known = static_cast<std::int64_t>(detail::Migrations().size());
  return database.Count("PRAGMA application_id") == detail::kApplicationId && database.UserVersion() >= 1 &&
         database.UserVersion() < known;
}

}  // namespace

Result<Record> OpenOther(const std::filesystem::path& folder, const std::filesystem::path& scratch,
                         const Stamp& stamp) {
  const std::filesystem::path file = folder / "study.db", copy = scratch / "study.db";
  const auto copied = Guarded([&] {
    if (!std::filesystem::exists(file) || !IsOlder(file)) return false;
    Database(file, false).Run("VACUUM INTO ?", {copy.string()});
    Database database(copy, false);
    database.Configure();
    database.Execute("PRAGMA journal_mode=WAL");
    detail::BringUpToDate(database, copy, detail::Migrations());
    return true;
  });
  if (!copied) return Fail(copied.error());
  if (!*copied) return Record::Open(folder, stamp);
  return Guarded([&] {
    Database database(copy, false);
    database.Configure();
    return detail::Access::Make({folder, Unwrap(ObjectStore::Open(folder / "objects")), std::move(database)});
  });
}

Result<MergeReport> Merge(Record& into, Record& other, const Progress& progress, const Stamp& stamp) {
  return Guarded([&] {
    Record::Impl& mine = detail::Access::Of(into);
    Record::Impl& theirs = detail::Access::Of(other);
    RefuseOtherStudy(mine.database, theirs.database);
    RefuseUnlessSound(mine);
    // One state of the other copy, whoever writes to it meanwhile.
    theirs.database.Execute("BEGIN");
    MergeReport report;
    const auto done = Guarded([&] {
      RefuseUnlessSound(theirs);
      CompareChains(mine.database, theirs.database);
      CopyObjects(mine, theirs, progress, report);
      TakeRows(mine, theirs, stamp, progress, report);
    });
    theirs.database.Execute("ROLLBACK");
    Unwrap(done);
    return report;
  });
}

}  // namespace striae::store
