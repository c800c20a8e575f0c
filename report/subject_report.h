// What a report is made of: plain values that app/ gathers from the record. No file, clock or database is touched here.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/measurement.h"
#include "core/study.h"
#include "core/time.h"

namespace striae::report {

/// One photograph of a visit and what became of it.
struct CaptureEntry {
  Capture capture;                       ///< role, body site, file name and digest are used
  std::vector<AnalysisReport> analyses;  ///< what was measured from it; none when it was not analysed
  std::string failure;                   ///< why there is no measurement; empty when there is one or none is meant
  std::vector<std::uint8_t> photograph;  ///< PNG or JPEG; empty when there is none
  std::vector<std::uint8_t> depth_map;   ///< PNG or JPEG with its own colour bar; empty when there is none
};

/// One session of a visit on its day. A visit with two sessions has two entries.
struct VisitEntry {
  std::string name;                    ///< "V1"
  Date date;                           ///< the day of the session; for a missed visit the planned day
  std::string status;                  ///< "in window", "3 days late"; empty when no window is planned
  std::string missing;                 ///< why the visit has no captures; empty when it has
  std::vector<CaptureEntry> captures;  ///< in the order they were taken
};

/// What counts as better for head angles, which no single rule can say: in dystonia a posture nearer to neutral,
/// in a test of mobility a wider movement.
enum class HeadGoal { kNearerNeutral, kWiderMovement };

/// Everything of one subject, for one report.
struct SubjectReport {
  Study study;
  Site site;
  Subject subject;
  std::vector<std::string> devices;       ///< one line each, "NIKON D90 2000123, small range"
  std::vector<std::string> calibrations;  ///< one line each, with the day from which it is valid and its digest
  std::string software_version;
  UtcTime generated_at;
  HeadGoal head_goal = HeadGoal::kNearerNeutral;
  std::vector<VisitEntry> visits;
};

}  // namespace striae::report
