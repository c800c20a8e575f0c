// Measurements in their place in the study, and the counts of the study's state.
#include "store/detail/impl.h"
#include "store/detail/read.h"

namespace striae::store {
namespace {

using detail::Guarded;
using detail::RowView;
using nlohmann::json;

constexpr const char* kResults = R"sql(
SELECT m.id, m.outcome_id, m.content, o.analysis, o.version, s.id, s.pseudonym, s.site_id, s.given, s.withdrawn,
  v.id, v.name, e.id, e.opened_at, c.id, c.role, o.at,
  EXISTS (SELECT 1 FROM outcome newer WHERE newer.supersedes = o.id),
  EXISTS (SELECT 1 FROM stale_mark k WHERE k.capture_id = c.id AND k.outcomes >= o.number),
  (SELECT group_concat(reason, '; ') FROM exclusion_now x WHERE x.capture_id = c.id
    AND (x.analysis IS NULL OR (x.analysis = o.analysis AND x.name = m.name)))
FROM measurement m JOIN outcome o ON o.id = m.outcome_id JOIN capture c ON c.id = o.capture_id
  JOIN session e ON e.id = c.session_id JOIN subject_now s ON s.id = e.subject_id JOIN visit v ON v.id = e.visit_id
WHERE (?1 IS NULL OR s.id = ?1) AND (?2 IS NULL OR e.id = ?2)
  AND (?3 OR NOT EXISTS (SELECT 1 FROM outcome newer WHERE newer.supersedes = o.id))
ORDER BY s.pseudonym, e.opened_at, e.id, c.number, o.number, m.number
)sql";

ResultRow ReadResult(const RowView& row) {
  ResultRow result;
  result.id = row.Key<MeasurementId>(0);
  result.report = row.Key<ReportId>(1);
  result.measurement = detail::Unwrap(MeasurementFromJson(json::parse(row.Text(2))));
  result.analysis = row.Text(3);
  result.version = row.Text(4);
  result.subject = {row.Key<SubjectId>(5), row.Text(6), row.Key<SiteId>(7), {}, {}};
  if (!row.IsNull(8)) result.subject.consent_given = row.Day(8);
  if (!row.IsNull(9)) result.subject.consent_withdrawn = row.Day(9);
  result.visit = {row.Key<VisitId>(10), result.subject.id, row.Text(11)};
  result.session = row.Key<SessionId>(12);
  result.session_opened_at = row.Time(13);
  result.capture = row.Key<CaptureId>(14);
  result.role = detail::Unwrap(CaptureRole::Parse(row.Text(15)));
  result.measured_at = row.Time(16);
  result.superseded = row.Integer(17) != 0;
  result.stale = row.Integer(18) != 0;
  result.excluded = row.OptionalText(19);
  return result;
}

}  // namespace

Result<std::vector<ResultRow>> Record::Results(const ResultFilter& filter) {
  return Guarded([&] {
    if (filter.subject) detail::GetSubject(impl_->database, *filter.subject);
    if (filter.session) detail::GetSession(impl_->database, *filter.session);
    return impl_->database.Rows(kResults, ReadResult, filter.subject, filter.session, filter.with_superseded ? 1 : 0);
  });
}

Result<Overview> Record::GetOverview() {
  return Guarded([&] {
    detail::Database& db = impl_->database;
    Overview o;
    o.subjects = db.Count("SELECT count(*) FROM subject");
    o.subjects_with_consent =
        db.Count("SELECT count(*) FROM subject_now WHERE given IS NOT NULL AND withdrawn IS NULL");
    o.visits = db.Count("SELECT count(*) FROM visit");
    o.sessions = db.Count("SELECT count(*) FROM session");
    o.open_sessions = db.Count("SELECT count(*) FROM session WHERE closed_at IS NULL");
    o.captures = db.Count("SELECT count(*) FROM capture");
    o.unassigned_captures = db.Count("SELECT count(*) FROM capture WHERE role = 'unassigned'");
    o.unprocessed_captures = db.Count(
        "SELECT count(*) FROM capture WHERE role <> 'unassigned' AND id NOT IN (SELECT capture_id FROM outcome)");
    o.failed_captures = db.Count("SELECT count(DISTINCT capture_id) FROM outcome_now WHERE failure_code IS NOT NULL");
    o.wounds_without_outline = db.Count(
        "SELECT count(*) FROM capture WHERE role LIKE 'wound:%' AND id NOT IN (SELECT capture_id FROM outline)");
    o.measurements = db.Count("SELECT count(*) FROM measurement WHERE outcome_id IN (SELECT id FROM outcome_now)");
    return o;
  });
}

}  // namespace striae::store
