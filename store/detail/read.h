// From rows to the vocabulary. Get... throws Failed (kNotFound, with what to do) for an id that is not in the record.
#pragma once

#include <string>

#include "core/study.h"
#include "store/detail/database.h"
#include "store/entries.h"
#include "store/objects.h"

namespace striae::store::detail {

inline constexpr const char* kSubjects = "SELECT id, pseudonym, site_id, given, withdrawn FROM subject_now";
inline constexpr const char* kVisits = "SELECT id, subject_id, name FROM visit";
inline constexpr const char* kDevices = "SELECT id, serial, range, model, lens FROM device";
inline constexpr const char* kCalibrations = "SELECT id, device_id, sha256, valid_from FROM calibration";
inline constexpr const char* kSessions =
    "SELECT id, subject_id, visit_id, operator, opened_at, closed_at, site_time_zone, camera_clock_offset_s, day FROM "
    "session";
inline constexpr const char* kCaptures =
    "SELECT id, session_id, sha256, file_name, media_type, size_bytes, role, body_site, laterality, imported_at, "
    "metadata, preflight FROM capture";
inline constexpr const char* kOutlines = "SELECT id, capture_id, sha256, drawn_by, added_at FROM outline";
inline constexpr const char* kDerived =
    "SELECT capture_id, kind, media_type, sha256, object, size_bytes, provenance, made_at FROM derived";
inline constexpr const char* kOutcomeColumns =
    "SELECT id, capture_id, analysis, report, failure_code, failure_message, failure_context, supersedes, at FROM ";

Subject ReadSubject(const RowView& row);
Visit ReadVisit(const RowView& row);
Device ReadDevice(const RowView& row);
CalibrationReference ReadCalibration(const RowView& row);
Session ReadSession(const RowView& row);
Capture ReadCapture(const RowView& row);
StoredOutline ReadOutline(const RowView& row);  ///< without the polygon, which is in objects/
Derived ReadDerivedRow(const RowView& row);
Outcome ReadOutcome(const RowView& row);

Subject GetSubject(Database& database, const SubjectId& id);
Visit GetVisit(Database& database, const VisitId& id);
Device GetDevice(Database& database, const DeviceId& id);
Session GetSession(Database& database, const SessionId& id);
Capture GetCapture(Database& database, const CaptureId& id);
std::optional<StoredOutline> FindOutline(Database& database, const ObjectStore& objects, const CaptureId& capture);

/// Next `number` within a parent: 1 for the first.
std::int64_t NextNumber(Database& database, const std::string& table, const std::string& parent_column,
                        const std::string& parent);

}  // namespace striae::store::detail
