// The bytes that an audit row's hash covers.
#pragma once

#include "store/audit.h"
#include "store/detail/database.h"

namespace striae::store::detail {

/// SHA-256 of: the previous row's hash (32 bytes; zeros for row 1), then each of origin, sequence, utc, utc_offset_min,
/// zone, user, machine, software, action, entity, entity_id, field, old_value, new_value, reason as
/// "<length in bytes>:<bytes>" or "-" for none. No two different rows give the same bytes.
Sha256 HashOf(const AuditRow& row);

inline constexpr const char* kAuditColumns =
    "origin, sequence, utc, utc_offset_min, zone, user, machine, software, action, entity, entity_id, field, "
    "old_value, "
    "new_value, reason, previous_hash, hash";
/// A row of `SELECT kAuditColumns FROM audit`.
AuditRow ReadAuditRow(const RowView& row);

}  // namespace striae::store::detail
