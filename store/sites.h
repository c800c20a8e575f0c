// Further sites of a study; the first one is made with the study. Record::Sites lists them.
#pragma once

#include "core/result.h"
#include "store/record.h"
#include "store/stamp.h"

namespace striae::store {

/// kUsage unless the code has 1 to 16 characters without spaces; kRecordRefused when it is taken (whatever the case of
/// its letters) or the study is locked. Whether the time zone exists is for the caller, who knows the system's list.
Status AddSite(Record& record, const Site& site, const Stamp& stamp);

}  // namespace striae::store
