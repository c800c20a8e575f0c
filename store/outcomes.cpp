// What processing came to: numbers or the reason for none. Nothing is changed afterwards; a newer outcome supersedes.
#include "store/detail/codec.h"
#include "store/detail/read.h"
#include "store/detail/words.h"

namespace striae::store {
namespace {

using detail::Columns;

std::optional<Outcome> InForce(Database& database, const CaptureId& capture, const std::string& analysis) {
  return database.One(std::string(detail::kOutcomeColumns) +
                          "outcome_now WHERE capture_id = ? AND analysis = ? ORDER BY number DESC LIMIT 1",
                      detail::ReadOutcome, capture, analysis);
}

bool SameContent(const Outcome& a, const Outcome& b) {
  const auto key = [](const Outcome& o) {
    return std::pair(o.failure ? std::string(ToString(o.failure->code)) + o.failure->message : std::string(),
                     detail::Dump(ToJson(o.report)));
  };
  return key(a) == key(b);
}

void InsertMeasurements(Change& change, const Outcome& outcome) {
  std::int64_t number = 0;
  for (const Measurement& m : outcome.report.measurements) {
    ++number;
    const Uuid id = detail::UuidFrom({"measurement", outcome.id.ToString(), std::to_string(number), m.name});
    change.Insert("measurement", {{"id", ToValue(id.ToString())},
                                  {"outcome_id", ToValue(outcome.id)},
                                  {"number", number},
                                  {"name", ToValue(m.name)},
                                  {"value", ToValue(m.value)},
                                  {"unit", ToValue(m.unit)},
                                  {"uncertainty", ToValue(m.uncertainty)},
                                  {"status", ToValue(m.status == Measurement::Status::kOk ? "ok" : "flagged")},
                                  {"content", ToValue(detail::Dump(ToJson(m)))}});
  }
}

Outcome Add(Database& database, Outcome outcome, const Stamp& stamp) {
  Change change(database, stamp);
  detail::GetCapture(database, outcome.capture);
  const auto before = InForce(database, outcome.capture, outcome.analysis);
  // Processing again from the same inputs gives the same outcome: it is there already.
  // Unless its capture was reassigned since: then it says that the number holds for the new place.
  const bool stale = before && database.Count(
                                   "SELECT count(*) FROM stale_mark k JOIN outcome o ON o.capture_id = k.capture_id "
                                   "WHERE o.id = ? AND k.outcomes >= o.number",
                                   before->id) != 0;
  if (before && !stale && SameContent(*before, outcome)) return *before;
  if (before) outcome.supersedes = before->id;
  Columns columns = {{"id", ToValue(outcome.id)},
                     {"capture_id", ToValue(outcome.capture)},
                     {"number", detail::NextNumber(database, "outcome", "capture_id", outcome.capture.ToString())},
                     {"analysis", ToValue(outcome.analysis)},
                     {"version", ToValue(outcome.report.version)},
                     {"report", ToValue(detail::Dump(ToJson(outcome.report)))},
                     {"supersedes", ToValue(outcome.supersedes)},
                     {"at", ToValue(outcome.at)}};
  if (outcome.failure) {
    columns.emplace_back("failure_code", ToValue(ToString(outcome.failure->code)));
    columns.emplace_back("failure_message", ToValue(outcome.failure->message));
    columns.emplace_back("failure_context", ToValue(detail::Dump(outcome.failure->context)));
  }
  change.Insert("outcome", columns, stale ? "processed again after a reassignment" : before ? "processed again" : "");
  InsertMeasurements(change, outcome);
  change.Commit();
  return outcome;
}

}  // namespace

Result<Outcome> Record::AddReport(const ReportId& id, const CaptureId& capture, const AnalysisReport& report,
                                  const Stamp& stamp) {
  return Guarded([&] {
    if (report.analysis.empty()) Refuse(ErrorCode::kUsage, "a report needs the name of its analysis");
    for (const Measurement& measurement : report.measurements) {
      detail::Unwrap(MeasurementFromJson(ToJson(measurement)));
      if (measurement.name.empty() || measurement.unit.empty()) {
        Refuse(ErrorCode::kUsage, "a measurement of analysis '" + report.analysis + "' has no name or no unit");
      }
    }
    return Add(impl_->database, {id, capture, report.analysis, std::nullopt, report, stamp.now, std::nullopt}, stamp);
  });
}

Result<Outcome> Record::AddFailure(const ReportId& id, const CaptureId& capture, const AnalysisReport& report,
                                   const Error& failure, const Stamp& stamp) {
  return Guarded([&] {
    if (report.analysis.empty() || !report.measurements.empty()) {
      Refuse(ErrorCode::kUsage, "a failed outcome needs the name of its analysis and has no measurements");
    }
    return Add(impl_->database, {id, capture, report.analysis, failure, report, stamp.now, std::nullopt}, stamp);
  });
}

Result<std::vector<Outcome>> Record::Outcomes(const CaptureId& capture) {
  return Guarded([&] {
    detail::GetCapture(impl_->database, capture);
    return impl_->database.Rows(std::string(detail::kOutcomeColumns) + "outcome WHERE capture_id = ? ORDER BY number",
                                detail::ReadOutcome, capture);
  });
}

Result<Outcome> Record::OutcomeById(const ReportId& id) {
  return Guarded([&] {
    auto found =
        impl_->database.One(std::string(detail::kOutcomeColumns) + "outcome WHERE id = ?", detail::ReadOutcome, id);
    if (!found) Refuse(ErrorCode::kNotFound, "no report " + id.ToString() + " in this study; see 'striae results'");
    return *std::move(found);
  });
}

}  // namespace striae::store
