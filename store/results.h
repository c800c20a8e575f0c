// The study's measurements one after another, for studies of any size: nothing is kept but the row at hand.
#pragma once

#include <functional>
#include <string>

#include "store/entries.h"
#include "store/record.h"

namespace striae::store {

/// In the order of Record::Results. `row.measurement` has name, value, unit, uncertainty, status and reason; its codes
/// stand in `json`, which is ToJson(ResultRow) as compact text. Both hold until the call returns.
using VisitResult = std::function<void(const ResultRow& row, const std::string& json)>;
Status EachResult(Record& record, const ResultFilter& filter, const VisitResult& visit);

}  // namespace striae::store
