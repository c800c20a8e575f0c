#include "store/backup.h"

#include <system_error>

#include <unistd.h>

#include "store/detail/codec.h"
#include "store/detail/disk.h"
#include "store/detail/words.h"
#include "store/identity.h"

namespace striae::store {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDraftName = ".study.db.new";

std::span<const std::uint8_t> BytesOf(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

void MakeDestination(const fs::path& folder) {
  std::error_code code;
  if (fs::exists(folder / kUnfinishedName, code)) {
    Refuse(ErrorCode::kRecordRefused, folder.string() + " holds an interrupted copy (see its file " + kUnfinishedName +
                                          "); remove that folder or choose another, then repeat");
  }
  if (fs::exists(folder, code) && !(fs::is_directory(folder, code) && fs::is_empty(folder, code))) {
    Refuse(ErrorCode::kRecordRefused, folder.string() + " is not empty; nothing is overwritten, choose a new folder");
  }
  fs::create_directories(folder, code);
  if (!fs::is_directory(folder)) {
    Refuse(ErrorCode::kIo, "cannot make " + folder.string() + " (" + code.message() + "); check the permissions");
  }
  const std::string text =
      "This copy of a study was not finished. It is no backup: remove the folder and make the copy again.\n";
  detail::WriteNew(folder / kUnfinishedName, BytesOf(text));
}

/// One state of the database into a file of its own, with nothing left in a log.
void CopyDatabase(const fs::path& from, const fs::path& to) {
  std::error_code code;
  const auto log_size = fs::file_size(from.string() + "-wal", code);
  if (::access(from.parent_path().c_str(), W_OK) != 0 && (code || log_size == 0)) {
    detail::CopyNew(from, to);  // on a medium that is read-only SQLite cannot open a file with a log
    fs::permissions(to, fs::perms::owner_write, fs::perm_options::add);
    return;
  }
  Database source(from, false);
  source.Configure();
  // VACUUM INTO reads one state in one transaction, as sqlite3_backup does in one step, and writers go on.
  source.Run("VACUUM INTO ?", {to.string()});
  Database copy(to, false);
  copy.Execute("PRAGMA journal_mode=WAL");
}

void CopyFolder(const fs::path& from, const fs::path& to) {
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(from, absent)) {
    if (!entry.is_regular_file() || entry.path().filename().string().find(".part-") != std::string::npos) continue;
    detail::MakeFolder(to);
    detail::CopyNew(entry.path(), to / entry.path().filename());
  }
}

void CopyObjects(Database& named_by, const ObjectStore& from, const ObjectStore& to, const Progress& progress,
                 BackupReport& report) {
  const auto all = static_cast<std::size_t>(named_by.Count("SELECT count(*) FROM object"));
  named_by.Each("SELECT id, size_bytes FROM object ORDER BY id", [&](const RowView& row) {
    const Sha256 sha256 = row.Hash(0);
    if (!from.Has(sha256)) {
      Refuse(ErrorCode::kRecordDamaged, "object " + sha256.ToString() + " is missing; run 'striae check' first");
    }
    Unwrap(to.PutFile(from.PathOf(sha256), sha256));
    ++report.objects;
    report.bytes += static_cast<std::uint64_t>(row.Integer(1));
    if (progress) progress(static_cast<std::size_t>(report.objects), all, "objects");
  });
}

/// Everything but the last step: objects and drafts lie in `to`, and study.db has its draft's name.
void CopyStudy(const fs::path& from, const ObjectStore& objects, const fs::path& to, const Progress& progress,
               BackupReport& report) {
  MakeDestination(to);
  CopyDatabase(from / "study.db", to / kDraftName);
  {
    Database copy(to / kDraftName, false);
    const auto kept = Unwrap(ObjectStore::Open(to / "objects"));
    CopyObjects(copy, objects, kept, progress, report);
  }
  CopyFolder(from / "quarantine", to / "quarantine");
}

/// As private as the first.
void CopyIdentities(const fs::path& from, const fs::path& to) {
  if (!fs::exists(from / kIdentityName)) return;
  detail::CopyNew(from / kIdentityName, to / kIdentityName);
  fs::permissions(to / kIdentityName, fs::perms::owner_read | fs::perms::owner_write);
}

/// Gives the copy its study.db, checks it, and only then takes the mark of the unfinished away.
void Finish(const fs::path& folder, const Progress& progress, const Stamp& stamp, BackupReport& report) {
  for (const char* suffix : {"-wal", "-shm"}) {
    std::error_code ignored;
    fs::remove(folder / (std::string(kDraftName) + suffix), ignored);
  }
  if (!detail::MoveNew(folder / kDraftName, folder / "study.db")) {
    Refuse(ErrorCode::kRecordRefused, folder.string() + " got a study from another program meanwhile");
  }
  auto copy = Unwrap(Record::Open(folder, stamp));
  CheckOptions options;
  options.progress = progress;
  report.check = Unwrap(Check(copy, options));
  report.head = report.check.head;
  for (const Finding& finding : report.check.findings) {
    if (finding.severity != Finding::Severity::kError) continue;
    Refuse(ErrorCode::kRecordDamaged, "the copy does not pass: " + finding.where + " " + finding.what);
  }
}

void TakeMarkAway(const fs::path& folder) {
  ::unlink((folder / kUnfinishedName).c_str());
  detail::SyncFolder(folder);
}

nlohmann::json ManifestOf(const BackupReport& report, const Stamp& stamp) {
  return {{"format", "striae-backup 1"},
          {"made_at", stamp.now.ToString()},
          {"head", ToText(report.head)},
          {"objects", report.objects},
          {"bytes", report.bytes}};
}

/// The head that the backup was left with, when it says so.
std::optional<AuditHead> HeadOfManifest(const fs::path& folder) {
  if (!fs::exists(folder / kManifestName)) return std::nullopt;
  const auto bytes = detail::ReadWhole(folder / kManifestName);
  const auto manifest = nlohmann::json::parse(bytes.begin(), bytes.end(), nullptr, false);
  const auto head = manifest.is_object() && manifest.contains("head") && manifest["head"].is_string()
                        ? ParseHead(manifest["head"].get<std::string>())
                        : Result<AuditHead>(Fail(ErrorCode::kBadFile, ""));
  if (!head) {
    Refuse(ErrorCode::kBadFile,
           (folder / kManifestName).string() + " cannot be read; run 'striae check' on the backup");
  }
  return *head;
}

/// A copy that goes its own way from here: a new chain, which says what it had before.
void Branch(const fs::path& folder, const Uuid& origin, const Stamp& stamp) {
  Database database(folder / "study.db", false);
  database.Configure();
  nlohmann::json heads = nlohmann::json::object();
  database.Each("SELECT origin, max(sequence) FROM audit GROUP BY origin",
                [&](const RowView& row) { heads[row.Text(0)] = row.Integer(1); });
  detail::Change change(database, stamp);
  database.Run("UPDATE this_copy SET origin = ?", {origin.ToString()});
  change.Note("merge", "branch", "", heads.dump());
  change.Commit();
}

}  // namespace

Result<BackupReport> Backup(Record& record, const fs::path& destination, const Progress& progress, const Stamp& stamp) {
  return Guarded([&] {
    const Record::Impl& study = detail::Access::Of(record);
    BackupReport report;
    CopyStudy(study.folder, study.objects, destination, progress, report);
    CopyIdentities(study.folder, destination);
    Finish(destination, progress, stamp, report);
    const std::string manifest = ManifestOf(report, stamp).dump(1) + "\n";
    detail::WriteNew(destination / kManifestName, BytesOf(manifest));
    TakeMarkAway(destination);
    return report;
  });
}

Result<BackupReport> Restore(const fs::path& source, const fs::path& destination, const RestoreOptions& options,
                             const Stamp& stamp) {
  return Guarded([&] {
    if (fs::exists(source / kUnfinishedName)) {
      Refuse(ErrorCode::kRecordRefused, source.string() + " is an interrupted backup (it holds the file " +
                                            kUnfinishedName + "); use an older one");
    }
    if (!fs::exists(source / "study.db")) {
      Refuse(ErrorCode::kNotFound, "no backup in " + source.string() + " (study.db is not there); check the folder");
    }
    const auto noted = HeadOfManifest(source);
    BackupReport report;
    CopyStudy(source, Unwrap(ObjectStore::Open(source / "objects")), destination, options.progress, report);
    if (!options.branch) CopyIdentities(source, destination);  // names stay at their site
    Finish(destination, options.progress, stamp, report);
    if (noted && (noted->sequence != report.head.sequence || noted->hash != report.head.hash)) {
      Refuse(ErrorCode::kRecordDamaged, source.string() + " was changed since the backup was made: its trail ends at " +
                                            ToText(report.head) + ", not at " + ToText(*noted) +
                                            "; use another backup");
    }
    if (options.branch) Branch(destination, *options.branch, stamp);
    TakeMarkAway(destination);
    return report;
  });
}

}  // namespace striae::store
