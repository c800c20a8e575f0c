// From captures to values over visits: which captures belong together, repeats, days.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "report/subject_report.h"
#include "report/verdict.h"

namespace striae::report::detail {

struct Value {
  Reading reading;
  std::string reason;  ///< why it is flagged
};

struct SeriesColumn {
  const VisitEntry* visit = nullptr;
  std::int64_t day = 0;                       ///< since the subject's first visit with captures
  std::vector<const CaptureEntry*> captures;  ///< one, or the repeats
  std::map<std::string, Value> values;        ///< by the quantity's local name
  std::vector<std::string> notes;             ///< repeats averaged or left out
};

struct Series {
  std::string title;               ///< "Wound W1, left calf"
  std::vector<std::string> names;  ///< quantities in the order of the table
  std::vector<SeriesColumn> columns;

  /// The first column that has the quantity; nullptr when none has.
  [[nodiscard]] const SeriesColumn* First(const std::string& name) const;
  [[nodiscard]] const SeriesColumn* Last(const std::string& name) const;
};

/// Visits by date, ties in their given order.
std::vector<const VisitEntry*> InOrder(const SubjectReport& subject);

/// One series a wound label, one for the k-th pose of each session. Pointers point into `subject`.
std::vector<Series> GatherSeries(const SubjectReport& subject);

}  // namespace striae::report::detail
