// One series of values as table, headlines, plots and pictures.
#pragma once

#include "report/detail/series.h"
#include "report/page.h"

namespace striae::report::detail {

Section MakeSection(const Series& series, HeadGoal goal);

/// "V1 · 2026-05-04"
std::string VisitText(const VisitEntry& visit);

}  // namespace striae::report::detail
