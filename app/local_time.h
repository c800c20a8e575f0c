// Between UTC and the wall clock of a site, by the system's time zone database.
#pragma once

#include <string>

#include "core/result.h"
#include "core/time.h"

namespace striae::app {

/// "2026-05-04" (noon of that day) or "2026-05-04T10:30" at the site, or with "Z" at its end in UTC. A time that the
/// change to summer time leaves out is an hour later; of one that comes twice, the first. kUsage for anything else and
/// for a zone that the system does not know.
Result<UtcTime> ParseLocal(const std::string& text, const std::string& zone);

/// The day at the site. An empty or unknown zone is taken as UTC.
Date DayAt(UtcTime time, const std::string& zone);

/// kUsage for a zone that the system's database does not have; without a database every zone is taken as it is.
Status CheckZone(const std::string& zone);

}  // namespace striae::app
