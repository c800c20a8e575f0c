// A whole copy of a study, taken while others work with it, and the way back.
#pragma once

#include <filesystem>
#include <optional>

#include "store/check.h"
#include "store/progress.h"
#include "store/record.h"

namespace striae::store {

struct BackupReport {
  AuditHead head;  ///< of the copy: what was written later is not in it
  std::int64_t objects = 0;
  std::uint64_t bytes = 0;
  CheckReport check;  ///< of the copy, after it was written
};

/// Copies study.db (SQLite's online backup: one state, other programs go on writing), every object it names, the
/// quarantine and identity.striae into `destination`, which must be absent or empty. Each object is hashed on its way
/// and the whole copy is checked at the end. Until then the copy has no study.db and holds a file UNFINISHED, so that
/// an interrupted backup cannot be mistaken for a whole one. backup.json gives the head, counts and time.
/// kRecordRefused when the destination holds anything; kRecordDamaged when the study or the copy does not pass.
Result<BackupReport> Backup(Record& record, const std::filesystem::path& destination, const Progress& progress,
                            const Stamp& stamp);

struct RestoreOptions {
  /// Set: the restored study is a new copy with this origin, for another site or machine that works beside the first
  /// and is merged with it later. Not set: it takes the place of a study that was lost, and goes on with its trail.
  std::optional<Uuid> branch;
  Progress progress;
};

/// Makes a study in `destination` (absent or empty) from a backup, or from any study that no program is writing to.
/// Equal head, equal objects; checked before it gets its study.db. kRecordRefused for an unfinished backup.
Result<BackupReport> Restore(const std::filesystem::path& source, const std::filesystem::path& destination,
                             const RestoreOptions& options, const Stamp& stamp);

inline constexpr const char* kUnfinishedName = "UNFINISHED";
inline constexpr const char* kManifestName = "backup.json";

}  // namespace striae::store
