#include "store/json.h"

#include "store/detail/codec.h"

namespace striae::store {
namespace {

using nlohmann::json;

template <typename T>
json TextOrNull(const std::optional<T>& value) {
  return value ? json(value->ToString()) : json();
}

/// Old and new values are JSON text; anything else is shown as it stands.
json Parsed(const std::optional<std::string>& text) {
  if (!text) return nullptr;
  json value = json::parse(*text, nullptr, false);
  return value.is_discarded() ? json(*text) : value;
}

}  // namespace

json ToJson(const Study& study) {
  return {{"id", study.id.ToString()},
          {"protocol", study.protocol},
          {"title", study.title},
          {"sponsor", study.sponsor},
          {"coordinating_centre", study.coordinating_centre},
          {"subject_pattern", study.subject_pattern},
          {"check_digit", study.check_digit}};
}

json ToJson(const Site& site) {
  return {{"id", site.id.ToString()}, {"code", site.code}, {"name", site.name}, {"time_zone", site.time_zone}};
}

json ToJson(const Subject& subject) {
  return {{"id", subject.id.ToString()},
          {"pseudonym", subject.pseudonym},
          {"site", subject.site.ToString()},
          {"consent_given", TextOrNull(subject.consent_given)},
          {"consent_withdrawn", TextOrNull(subject.consent_withdrawn)},
          {"consent_active", subject.HasActiveConsent()}};
}

json ToJson(const Device& device) {
  return {{"id", device.id.ToString()},
          {"serial", device.serial},
          {"range", ToString(device.range)},
          {"model", device.model},
          {"lens", device.lens}};
}

json ToJson(const CalibrationReference& calibration) {
  return {{"id", calibration.id.ToString()},
          {"device", calibration.device.ToString()},
          {"sha256", calibration.sha256.ToString()},
          {"valid_from", calibration.valid_from.ToString()}};
}

json ToJson(const Session& session) {
  json object = {{"id", session.id.ToString()},
                 {"subject_id", session.subject.ToString()},
                 {"visit_id", session.visit.ToString()},
                 {"operator", session.operator_name},
                 {"opened_at", session.opened_at.ToString()},
                 {"closed_at", TextOrNull(session.closed_at)},
                 {"site_time_zone", session.site_time_zone},
                 {"camera_clock_offset_s", nullptr},
                 {"day", (session.day ? *session.day : Date::Of(session.opened_at)).ToString()}};
  if (session.camera_clock_offset_s) object["camera_clock_offset_s"] = *session.camera_clock_offset_s;
  return object;
}

json ToJson(const Capture& capture) {
  return {{"id", capture.id.ToString()},
          {"session", capture.session.ToString()},
          {"sha256", capture.sha256.ToString()},
          {"role", capture.role.ToString()},
          {"file_name", capture.file_name},
          {"media_type", capture.media_type},
          {"size_bytes", capture.size_bytes},
          {"body_site", capture.body_site},
          {"laterality", ToString(capture.laterality)},
          {"imported_at", capture.imported_at.ToString()},
          {"photograph", detail::MetadataToJson(capture.metadata)},
          {"preflight", detail::PreflightToJson(capture.preflight)}};
}

json ToJson(const StoredOutline& outline) {
  return {{"id", outline.id.ToString()},
          {"capture", outline.capture.ToString()},
          {"sha256", outline.sha256.ToString()},
          {"drawn_by", outline.drawn_by},
          {"added_at", outline.added_at.ToString()},
          {"points", outline.outline.polygon_px.size()}};
}

json ToJson(const Derived& derived) {
  return {{"capture", derived.capture.ToString()}, {"kind", derived.kind},
          {"media_type", derived.media_type},      {"sha256", derived.sha256.ToString()},
          {"object", derived.object.ToString()},   {"size_bytes", derived.size_bytes},
          {"made_at", derived.made_at.ToString()}, {"provenance", detail::ProvenanceToJson(derived.provenance)}};
}

json ToJson(const Outcome& outcome) {
  json object = striae::ToJson(outcome.report);
  object["id"] = outcome.id.ToString();
  object["capture"] = outcome.capture.ToString();
  object["at"] = outcome.at.ToString();
  object["supersedes"] = TextOrNull(outcome.supersedes);
  object["state"] = outcome.failure ? "failed" : "ok";
  if (outcome.failure) {
    object["failure"] = {{"code", ToString(outcome.failure->code)}, {"reason", outcome.failure->Describe()}};
  }
  return object;
}

json ToJson(const ResultRow& row) {
  json object = striae::ToJson(row.measurement);
  object["id"] = row.id.ToString();
  object["report"] = row.report.ToString();
  object["analysis"] = row.analysis;
  object["version"] = row.version;
  object["subject"] = row.subject.pseudonym;
  object["visit"] = row.visit.name;
  object["session"] = row.session.ToString();
  object["session_opened_at"] = row.session_opened_at.ToString();
  object["capture"] = row.capture.ToString();
  object["role"] = row.role.ToString();
  object["measured_at"] = row.measured_at.ToString();
  object["superseded"] = row.superseded;
  object["stale"] = row.stale;
  object["excluded"] = row.excluded ? json(*row.excluded) : json();
  object["consent_withdrawn"] = row.subject.consent_withdrawn.has_value();
  return object;
}

json ToJson(const AuditRow& row) {
  return {{"origin", row.origin},
          {"sequence", row.sequence},
          {"utc", row.stamp.now.ToString()},
          {"utc_offset_min", row.stamp.utc_offset_min},
          {"zone", row.stamp.zone},
          {"user", row.stamp.user},
          {"machine", row.stamp.machine},
          {"software", row.software},
          {"action", row.action},
          {"entity", row.entity},
          {"entity_id", row.entity_id},
          {"field", row.field},
          {"old", Parsed(row.old_value)},
          {"new", Parsed(row.new_value)},
          {"reason", row.reason},
          {"hash", row.hash.ToString()}};
}

json ToJson(const CheckReport& report) {
  json object = {{"passed", report.Passed()},
                 {"audit_rows", report.audit_rows},
                 {"objects", report.objects},
                 {"head", {{"sequence", report.head.sequence}, {"hash", report.head.hash.ToString()}}},
                 {"heads", json::array()},
                 {"findings", json::array()}};
  for (const AuditHead& head : report.heads) {
    object["heads"].push_back({{"origin", head.origin}, {"sequence", head.sequence}, {"hash", head.hash.ToString()}});
  }
  for (const Finding& finding : report.findings) {
    const bool error = finding.severity == Finding::Severity::kError;
    object["findings"].push_back(
        {{"severity", error ? "error" : "warning"}, {"where", finding.where}, {"what", finding.what}});
  }
  return object;
}

json ToJson(const Overview& o) {
  return {{"subjects", o.subjects},
          {"subjects_with_consent", o.subjects_with_consent},
          {"visits", o.visits},
          {"sessions", o.sessions},
          {"open_sessions", o.open_sessions},
          {"captures", o.captures},
          {"unassigned_captures", o.unassigned_captures},
          {"unprocessed_captures", o.unprocessed_captures},
          {"failed_captures", o.failed_captures},
          {"wounds_without_outline", o.wounds_without_outline},
          {"measurements", o.measurements}};
}

}  // namespace striae::store
