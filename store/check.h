// Proof that nothing in a study is missing or altered. Memory does not grow with the study: the trail is walked row by
// row, rows are compared one entity at a time, objects one of 256 parts at a time.
#pragma once

#include <vector>

#include "store/audit.h"
#include "store/progress.h"
#include "store/record.h"

namespace striae::store {

struct CheckOptions {
  /// Heads noted earlier: each must still be part of its copy's chain. An empty origin stands for this copy's own.
  std::vector<AuditHead> expected;
  Progress progress;
};

/// Verifies SQLite's own structure and foreign keys, the tables and their guards, each copy's chain, that every row is
/// as its trail says, that each object is there and unaltered, and that nothing else lies in the study's folder.
/// At most kMostFindings are kept of each kind of place; the rest is counted.
Result<CheckReport> Check(Record& record, const CheckOptions& options);

inline constexpr std::size_t kMostFindings = 200;

/// "NUMBER:HASH", or "NUMBER:HASH ORIGIN" for another copy's; ParseHead reads either.
std::string ToText(const AuditHead& head);
Result<AuditHead> ParseHead(std::string_view text);

}  // namespace striae::store
