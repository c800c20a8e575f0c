// Between what a person says and what the record calls it.
#pragma once

#include <string>

#include "core/result.h"
#include "core/study.h"
#include "store/record.h"

namespace striae::app {

/// The whole id, its first eight or more characters, or the code of a label (3F2A-91BC, in either case, with or without
/// the hyphen). kNotFound, with where to look, when there is none; kUsage when it fits several.
Result<Session> FindSession(store::Record& record, const std::string& text);

/// "subject S001", "session <id> (S001, V1)"; of anything else its kind and id.
Result<std::string> NameOf(store::Record& record, const store::Record::Found& found);
/// "S001, V1".
Result<std::string> PlaceOf(store::Record& record, const Session& session);

}  // namespace striae::app
