// The record as it was.
#pragma once

#include "store/record.h"

namespace striae::store {

/// The study as it stood at an instant: read-only, held in memory, rebuilt from the audit trail alone. Photographs and
/// derived files are read from the study's own objects/. Of each copy of the study the rows up to the last one that is
/// not later than `instant` count (the order is that of the numbers, also where a clock was set back). Every change of
/// it is refused. kNotFound when nothing was there yet; kRecordDamaged when the trail cannot be replayed.
Result<Record> AsOf(Record& record, UtcTime instant);

}  // namespace striae::store
