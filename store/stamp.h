// Who changes the record, when and on which machine. Handed in by app/: no clock is read in store/.
#pragma once

#include <string>

#include "core/time.h"

namespace striae::store {

/// Stands in every audit row. Make a fresh one for every change (app::NewStamp).
struct Stamp {
  UtcTime now;
  std::string user;        ///< who; never empty
  std::string machine;     ///< host name
  std::string zone;        ///< IANA name of the machine's time zone, e.g. Europe/Ljubljana; empty if not known
  int utc_offset_min = 0;  ///< local time minus UTC at `now`
};

}  // namespace striae::store
