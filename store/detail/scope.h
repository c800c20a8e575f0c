// What belongs to a study, subject, visit, session or capture.
#pragma once

#include <set>
#include <string>

#include "store/detail/database.h"
#include "store/record.h"

namespace striae::store::detail {

/// The ids of the entity itself and of the subjects, visits, sessions and captures within it. kUsage for others.
std::set<std::string> EntitiesWithin(Database& database, const Record::Found& target);

/// SHA-256 over the rows that are the content of `target`: for each of the tables in a fixed order, each row by id, as
/// "<table> <row as compact JSON, keys in alphabetical order>\n". Columns that are NULL are left out, so that a newer
/// format with further columns does not break a signature.
Sha256 ContentHash(Database& database, const Record::Found& target);

}  // namespace striae::store::detail
