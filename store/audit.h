// The audit trail and the check of the whole record.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/hex.h"
#include "core/time.h"
#include "store/stamp.h"

namespace striae::store {

/// One change. Rows are numbered within the copy of the study (`origin`) that wrote them, and each holds the SHA-256
/// over the previous row's hash and its own content (store/detail/audit_hash.h has the exact bytes).
struct AuditRow {
  std::string origin;  ///< UUID of the copy of the study
  std::int64_t sequence = 0;
  Stamp stamp;
  std::string software;                             ///< "striae 0.1.0"
  std::string action;                               ///< "create", "change", or "note" (the file's own format)
  std::string entity;                               ///< "subject", "capture", ...
  std::string entity_id;                            ///< UUID
  std::string field;                                ///< empty for create
  std::optional<std::string> old_value, new_value;  ///< JSON text; for create, new_value is the whole entity
  std::string reason;
  Sha256 previous_hash, hash;
};

/// The last row's number and hash: kept outside the study, it proves later that the trail was not cut at its end.
struct AuditHead {
  std::int64_t sequence = 0;
  Sha256 hash;
  std::string origin = {};  ///< of which copy; empty: of this one
};

struct Finding {
  enum class Severity { kError, kWarning };
  Severity severity = Severity::kError;
  std::string where;  ///< "audit row 12", "object 3f...", "capture ..."
  std::string what;   ///< what is wrong and what to do
};

struct CheckReport {
  std::vector<Finding> findings;
  std::int64_t audit_rows = 0, objects = 0;
  AuditHead head;                     ///< of this copy's chain
  std::vector<AuditHead> heads;       ///< of every copy's chain that has been merged, this one's included
  [[nodiscard]] bool Passed() const;  ///< no error (warnings allowed)
};

}  // namespace striae::store
