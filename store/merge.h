// Two copies of one study, worked on apart (`restore --branch`), brought together.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "store/progress.h"
#include "store/record.h"

namespace striae::store {

struct MergeReport {
  std::int64_t objects = 0, audit_rows = 0, rows = 0;  ///< taken from the other copy
  std::int64_t updated = 0;                            ///< rows that were here and are newer there
  std::vector<std::string> queries;                    ///< what two people must settle, one line each
};

/// Takes everything of `other` into `into`; `other` is only read. Files first, then rows and trails in one transaction.
///
/// Each copy's chain stays as it was written and is verified; this copy's chain gets one row that says what it has
/// taken in. Of two changes of one field that did not know of each other the later counts (UTC, then origin) and a
/// query is opened. Two rows that must differ and do not (a pseudonym given at both sites, a photograph imported at
/// both) both stay: the later one gets another name or place, and a query. What is merged does not depend on who takes
/// in whom, and merging again adds nothing.
///
/// kRecordRefused for another study, for copies that wrote on under one origin (a folder copied by hand), and for two
/// decisions that cannot both stand (one lock opened at both); kRecordDamaged when either copy does not pass its check.
Result<MergeReport> Merge(Record& into, Record& other, const Progress& progress, const Stamp& stamp);

/// The other copy, for Merge. One of an older format is copied to `scratch` (an empty folder) and brought up to date
/// there, its objects are read where they are: the other copy itself is never changed. kNotFound where there is none,
/// kRecordRefused for one of a newer format.
Result<Record> OpenOther(const std::filesystem::path& folder, const std::filesystem::path& scratch, const Stamp& stamp);

}  // namespace striae::store
