#include "store/detail/keep.h"

namespace striae::store::detail {

void InsertObject(Change& change, Database& database, const Sha256& sha256, std::uint64_t size_bytes,
                  const Stamp& stamp) {
  if (database.Count("SELECT count(*) FROM object WHERE id = ?", sha256) != 0) return;
  change.Insert("object",
                {{"id", ToValue(sha256)}, {"size_bytes", ToValue(size_bytes)}, {"kept_at", ToValue(stamp.now)}});
}

void InsertSite(Change& change, const Site& site) {
  change.Insert("site", {{"id", ToValue(site.id)},
                         {"code", ToValue(site.code)},
                         {"name", ToValue(site.name)},
                         {"time_zone", ToValue(site.time_zone)}});
}

}  // namespace striae::store::detail
