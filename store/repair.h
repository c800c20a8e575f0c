// Settles what a program that was stopped may leave, and nothing else: damage is named by Check and needs a backup.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "store/progress.h"
#include "store/record.h"

namespace striae::store {

struct RepairOptions {
  /// Another copy of the study (a backup, another site's): objects that are missing or damaged here are taken from it.
  std::optional<std::filesystem::path> from;
  Progress progress;
};

struct Repaired {
  std::string where, what;  ///< "object 3f...", "moved to quarantine/..."
};

/// Nothing is ever deleted that has content: unfinished files and objects without a row go to quarantine/ beside a note
/// (NAME.why.json); empty ones and the drafts of study.db are removed. An object that is missing or damaged comes back
/// from an unfinished file, a quarantined one or `from`, where one has its very bytes; the damaged file goes to
/// quarantine. The write-ahead log is brought into study.db. Each step is noted in the audit trail before it is made,
/// so that a kill leaves a step to repeat, never one without a note. kIo while another program has the study open.
Result<std::vector<Repaired>> Repair(Record& record, const RepairOptions& options, const Stamp& stamp);

}  // namespace striae::store
