// Wrong patient, wrong session: moving photographs with a reason. The old place stays in the trail, signatures over
// both places break, and what was computed is stale until it is processed again.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "store/record.h"
#include "store/users.h"

namespace striae::store {

struct Reassignment {
  Record::Found moved;         ///< the capture or session
  std::string from_id, to_id;  ///< sessions (of a capture) or subjects (of a session)
  SubjectId from_subject, to_subject;
  std::string reason, by;
  UtcTime at;
};

/// Moves captures to another session, all or none. kRecordRefused when a session is locked, the new subject has no
/// active consent, the new session has one of the photographs already, or one of them would stay under the old subject
/// too (a neutral pose used in several sessions: move all of its captures in one go).
Status ReassignCaptures(Record& record, std::span<const CaptureId> captures, const SessionId& to,
                        const std::string& reason, const SignedIn& by, const Stamp& stamp);

/// Moves a session with all its captures to another subject, into the visit of that name (made with `new_visit`
/// when the subject has none).
Status ReassignSession(Record& record, const SessionId& session, const SubjectId& to, std::string_view visit_name,
                       const VisitId& new_visit, const std::string& reason, const SignedIn& by, const Stamp& stamp);

/// Of one capture or session, or all; oldest first.
Result<std::vector<Reassignment>> Reassignments(Record& record, std::optional<std::string> moved = std::nullopt);

/// Captures whose outcome in force was computed for their place before.
Result<std::vector<CaptureId>> StaleCaptures(Record& record);

}  // namespace striae::store
