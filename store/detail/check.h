// The parts of Record::Check. Each adds what it finds and never stops at the first.
#pragma once

#include <optional>
#include <vector>

#include "store/audit.h"
#include "store/detail/database.h"
#include "store/objects.h"

namespace striae::store::detail {

/// SQLite's own structure and foreign keys.
void CheckDatabase(Database& database, CheckReport& report);
/// The chain of each origin: numbering, hashes, times; `expected` must be part of this copy's chain.
void CheckChain(Database& database, const std::optional<AuditHead>& expected, CheckReport& report);
/// Every row of every table is what its audit rows say, none is missing and none is without them.
void CheckRowsAgainstTrail(Database& database, CheckReport& report);
/// Every object is there with its content; nothing lies in objects/ that the record does not know.
void CheckObjects(Database& database, const ObjectStore& objects, CheckReport& report);

}  // namespace striae::store::detail
