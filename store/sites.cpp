#include "store/sites.h"

#include "store/detail/keep.h"
#include "store/detail/words.h"

namespace striae::store {

Status AddSite(Record& record, const Site& site, const Stamp& stamp) {
  return Guarded([&] {
    constexpr std::size_t kLongest = 16;
    if (site.code.empty() || site.code.size() > kLongest || site.code.find_first_of(" \t\r\n") != std::string::npos) {
      Refuse(ErrorCode::kUsage, "a site needs a code of 1 to 16 characters without spaces, such as LJ");
    }
    Database& database = Access::Of(record).database;
    Change change(database, stamp);
    if (database.Count("SELECT count(*) FROM site WHERE code = ? COLLATE NOCASE", site.code) != 0) {
      Refuse(ErrorCode::kRecordRefused, "site '" + site.code + "' is there already; see 'striae site list'");
    }
    detail::InsertSite(change, site);
    change.Commit();
  });
}

}  // namespace striae::store
