// Rows that several parts of the record write.
#pragma once

#include "core/study.h"
#include "store/detail/change.h"
#include "store/detail/database.h"

namespace striae::store::detail {

/// The row of an object that lies in objects/ already; nothing when it is there.
void InsertObject(Change& change, Database& database, const Sha256& sha256, std::uint64_t size_bytes,
                  const Stamp& stamp);
void InsertSite(Change& change, const Site& site);

}  // namespace striae::store::detail
