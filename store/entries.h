// What the record keeps beyond the vocabulary of core/study.h: outlines, derived files, outcomes, results.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/measurement.h"
#include "core/outline.h"
#include "core/provenance.h"
#include "core/study.h"

namespace striae::store {

/// A file that came from a capture: its surface, a preview, a report, a DICOM object.
struct Derived {
  CaptureId capture;
  std::string kind;  ///< "surface", "preview-photo", "preview-depth", ...
  std::string media_type;
  Sha256 sha256;  ///< of the file itself
  Sha256 object;  ///< of what is kept in objects/ (compressed for surfaces); equal to sha256 when not compressed
  std::uint64_t size_bytes = 0;  ///< of the file itself
  Provenance provenance;
  UtcTime made_at;
};

struct StoredOutline {
  OutlineId id;
  CaptureId capture;
  Sha256 sha256;  ///< of its canonical JSON in objects/
  std::string drawn_by;
  UtcTime added_at;
  Outline outline;
};

/// What processing a capture with one analysis came to: numbers, or the reason why there are none. Append-only: a new
/// outcome of the same capture and analysis supersedes the one before, which stays readable.
struct Outcome {
  ReportId id;
  CaptureId capture;
  std::string analysis;          ///< "wound", "head", or "surface" when it failed or ended before an analysis
  std::optional<Error> failure;  ///< set: `report` has provenance only
  AnalysisReport report;         ///< analysis and version filled in both cases
  UtcTime at;
  std::optional<ReportId> supersedes;
};

/// A capture with all that processing needs, each part as it is in force now.
struct WorkItem {
  Capture capture;
  Session session;
  Subject subject;
  std::optional<Device> device;
  std::optional<CalibrationReference> calibration;  ///< of that device on the session's day
  std::string missing;  ///< why device or calibration is absent, and what to do; empty when both are there
  std::optional<StoredOutline> outline;
  std::vector<Outcome> outcomes;  ///< those in force, one an analysis
};

/// A measurement in its place in the study.
struct ResultRow {
  MeasurementId id;
  ReportId report;
  Measurement measurement;
  std::string analysis, version;
  Subject subject;
  Visit visit;
  SessionId session;
  UtcTime session_opened_at;
  CaptureId capture;
  CaptureRole role;
  UtcTime measured_at;
  bool superseded = false;
  bool stale = false;                   ///< its capture was reassigned since; process it again
  std::optional<std::string> excluded;  ///< the reason, when it does not count
};

struct ResultFilter {
  std::optional<SubjectId> subject;
  std::optional<SessionId> session;
  bool with_superseded = false;
};

/// Counts for `status`.
struct Overview {
  std::int64_t subjects = 0, subjects_with_consent = 0, visits = 0;
  std::int64_t sessions = 0, open_sessions = 0;
  std::int64_t captures = 0, unassigned_captures = 0;
  std::int64_t unprocessed_captures = 0;  ///< with a role, and without any outcome
  std::int64_t failed_captures = 0;       ///< an outcome in force is a failure
  std::int64_t wounds_without_outline = 0;
  std::int64_t measurements = 0;  ///< in force
};

}  // namespace striae::store
