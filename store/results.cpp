#include "store/results.h"

#include "store/detail/codec.h"
#include "store/detail/read.h"
#include "store/detail/words.h"
#include "store/json.h"

namespace striae::store {
namespace {

using nlohmann::json;

// The outcomes in their order first, then each one's measurements: so nothing large is sorted.
constexpr const char* kOutcomes = R"sql(
SELECT o.id, o.analysis, o.version, s.id, s.pseudonym, s.site_id, s.given, s.withdrawn, v.id, v.name, e.id, e.opened_at,
  c.id, c.role, o.at, ?3 AND EXISTS (SELECT 1 FROM outcome newer WHERE newer.supersedes = o.id),
  EXISTS (SELECT 1 FROM stale_mark k WHERE k.capture_id = c.id AND k.outcomes >= o.number),
  EXISTS (SELECT 1 FROM exclusion x WHERE x.capture_id = c.id)
FROM outcome o JOIN capture c ON c.id = o.capture_id JOIN session e ON e.id = c.session_id
  JOIN subject_now s ON s.id = e.subject_id JOIN visit v ON v.id = e.visit_id
WHERE (?1 IS NULL OR s.id = ?1) AND (?2 IS NULL OR e.id = ?2) AND o.failure_code IS NULL
  AND (?3 OR NOT EXISTS (SELECT 1 FROM outcome newer WHERE newer.supersedes = o.id))
ORDER BY s.pseudonym, e.opened_at, e.id, c.number, o.number
)sql";
constexpr const char* kMeasurements =
    "SELECT id, name, value, unit, uncertainty, status, content FROM measurement WHERE outcome_id = ? ORDER BY number";
constexpr const char* kReasons =
    "SELECT group_concat(reason, '; ') FROM exclusion_now WHERE capture_id = ? AND (analysis IS NULL OR (analysis = ? "
    "AND name = ?))";

/// Where the measurements of an outcome stand.
ResultRow ReadPlace(const RowView& row) {
  ResultRow place;
  place.report = row.Key<ReportId>(0);
  place.analysis = row.Text(1);
  place.version = row.Text(2);
  place.subject = {row.Key<SubjectId>(3), row.Text(4), row.Key<SiteId>(5), {}, {}};
  if (!row.IsNull(6)) place.subject.consent_given = row.Day(6);
  if (!row.IsNull(7)) place.subject.consent_withdrawn = row.Day(7);
  place.visit = {row.Key<VisitId>(8), place.subject.id, row.Text(9)};
  place.session = row.Key<SessionId>(10);
  place.session_opened_at = row.Time(11);
  place.capture = row.Key<CaptureId>(12);
  place.role = detail::Unwrap(CaptureRole::Parse(row.Text(13)));
  place.measured_at = row.Time(14);
  place.superseded = row.Integer(15) != 0;
  place.stale = row.Integer(16) != 0;
  return place;
}

/// Calls `begin(place)` for each outcome and `visit(place, measurement's row)` for each of its measurements.
template <typename Begin, typename Visit>
void Walk(Database& database, const ResultFilter& filter, Begin begin, Visit visit) {
  if (filter.subject) detail::GetSubject(database, *filter.subject);
  if (filter.session) detail::GetSession(database, *filter.session);
  const auto outcome = [&](const RowView& row) {
    ResultRow place = ReadPlace(row);
    const bool excluded = row.Integer(17) != 0;
    begin(place);
    database.Each(
        kMeasurements,
        [&](const RowView& measurement) {
          place.id = measurement.Key<MeasurementId>(0);
          place.excluded.reset();
          if (excluded) {
            place.excluded = *database.One(
                kReasons, [](const RowView& reasons) { return reasons.OptionalText(0); }, place.capture, place.analysis,
                measurement.Text(1));
          }
          visit(place, measurement);
        },
        place.report);
  };
  database.Each(kOutcomes, outcome, filter.subject, filter.session, filter.with_superseded ? 1 : 0);
}

/// The fields of an outcome's rows that are the same for all of its measurements, to be put behind a measurement's own.
std::string TailOf(const ResultRow& place) {
  json object = ToJson(place);
  const json of_each = striae::ToJson(place.measurement);
  for (auto field = of_each.begin(); field != of_each.end(); ++field) object.erase(field.key());
  object.erase("id");
  object.erase("excluded");
  return object.dump().substr(1);
}

}  // namespace

Result<std::vector<ResultRow>> Record::Results(const ResultFilter& filter) {
  return Guarded([&] {
    std::vector<ResultRow> rows;
    Walk(
        impl_->database, filter, [](const ResultRow&) {},
        [&](ResultRow& place, const RowView& row) {
          place.measurement = detail::Unwrap(MeasurementFromJson(json::parse(row.Text(6))));
          rows.push_back(place);
        });
    return rows;
  });
}

Status EachResult(Record& record, const ResultFilter& filter, const VisitResult& visit) {
  return Guarded([&] {
    std::string tail, text;
    Walk(
        Access::Of(record).database, filter, [&](const ResultRow& place) { tail = TailOf(place); },
        [&](ResultRow& place, const RowView& row) {
          Measurement& m = place.measurement;
          m.name = row.Text(1);
          m.value = row.Real(2);
          m.unit = row.Text(3);
          m.uncertainty = row.Real(4);
          m.status = row.Text(5) == "ok" ? Measurement::Status::kOk : Measurement::Status::kFlagged;
          text = row.Text(6);
          // One accepted object, so that what is put behind its fields makes one object again.
          if (!text.starts_with('{') || !text.ends_with('}') || text.size() < 3 || !json::accept(text)) {
            Refuse(ErrorCode::kRecordDamaged, "measurement " + place.id.ToString() +
                                                  " in study.db holds JSON that cannot be read; run 'striae check'");
          }
          m.reason = m.status == Measurement::Status::kOk ? "" : json::parse(text).value("reason", "");
          text.back() = ',';
          text += "\"id\":\"" + place.id.ToString() + "\",\"excluded\":";
          text += place.excluded ? detail::Dump(*place.excluded) : std::string("null");
          text += ',';
          text += tail;
          visit(place, text);
        });
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
