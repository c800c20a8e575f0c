// What notes and treatments share: an entry that should not be there is superseded by one that says so.
#pragma once

#include <string>

#include "store/annotations.h"
#include "store/detail/change.h"
#include "store/detail/impl.h"
#include "store/detail/require.h"

namespace striae::store::detail {

template <typename Entry>
using InsertEntry = void (*)(Change& change, const Entry& entry, bool in_error, const std::string& reason,
                             const Stamp& stamp);

/// `in_force` refuses an id that is none.
template <typename Entry, typename IdType>
Status Strike(Record& record, Entry (*in_force)(Database&, const IdType&), InsertEntry<Entry> insert, const IdType& id,
              const IdType& new_id, const std::string& reason, const Stamp& stamp) {
  return Guarded([&] {
    RequireReason(reason, "a correction");
    Database& database = Access::Of(record).database;
    Change change(database, stamp);
    Entry struck = in_force(database, id);
    struck.id = new_id;
    struck.supersedes = id;
    insert(change, struck, true, reason, stamp);
    change.Commit();
  });
}

/// Also for the deviation that is noted when a session is opened.
void InsertNote(Change& change, const StudyNote& note, bool in_error, const std::string& reason, const Stamp& stamp);

}  // namespace striae::store::detail
