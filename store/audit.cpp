// Reading the audit trail.
#include "store/audit.h"

#include <algorithm>

#include "store/detail/audit_hash.h"
#include "store/detail/impl.h"

namespace striae::store {

using detail::Guarded;
using detail::RowView;

namespace {

/// The entries that end or answer an entry about a thing: they name that entry and not the thing.
constexpr const char* kAnswers =
    "SELECT u.id FROM unlock u JOIN lock l ON l.id = u.lock_id WHERE l.entity_id = ?1 "
    "UNION SELECT v.id FROM void_signature v JOIN signature s ON s.id = v.signature_id WHERE s.entity_id = ?1 "
    "UNION SELECT p.id FROM query_step p JOIN data_query q ON q.id = p.query_id WHERE q.entity_id = ?1";

}  // namespace

bool CheckReport::Passed() const {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& finding) { return finding.severity == Finding::Severity::kError; });
}

Result<std::vector<AuditRow>> Record::History(std::string_view entity) {
  const auto found = Find(entity);
  if (!found) return Fail(found.error());
  return Guarded([&] {
    // Consent, notes, locks and the like are entries of their own that name what they are about: they belong to its
    // history, and so does each change from it or to it (a reassignment). What lies below it has a history of its own.
    return impl_->database.Rows(
        "SELECT " + std::string(detail::kAuditColumns) +
            " FROM audit WHERE entity_id = ?1 OR (entity NOT IN ('visit', 'session', 'capture', 'outline', 'derived', "
            "'outcome', 'calibration') AND (instr(new_value, ?1) OR instr(old_value, ?1))) OR (action = 'change' AND "
            "(instr(new_value, ?1) OR instr(old_value, ?1))) OR entity_id IN (" +
            kAnswers + ") ORDER BY origin, sequence",
        detail::ReadAuditRow, found->id);
  });
}

Result<AuditHead> Record::Head() {
  return Guarded([&] {
    return impl_->database
        .One(
            "SELECT sequence, hash FROM audit WHERE origin = (SELECT origin FROM this_copy) ORDER BY sequence DESC "
            "LIMIT 1",
            [](const RowView& row) {
              return AuditHead{row.Integer(0), row.Hash(1)};
            })
        .value_or(AuditHead{});
  });
}

}  // namespace striae::store
