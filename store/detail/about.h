// What the study says about one of its things.
#pragma once

#include <nlohmann/json.hpp>

#include "store/record.h"

namespace striae::store::detail {

/// "notes", "queries", "signatures", "locks", "exclusions", "reassignments", for a subject also "arm" and
/// "treatments"; for a thing without a description of its own "referenced_by": the ids of the rows that point to it, by
/// table. What is empty is left out.
nlohmann::json About(Record& record, const Record::Found& found);

}  // namespace striae::store::detail
