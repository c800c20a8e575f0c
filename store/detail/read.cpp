#include "store/detail/read.h"

#include "store/detail/codec.h"

namespace striae::store::detail {
namespace {

using nlohmann::json;

template <typename Read, typename IdType>
auto GetOne(Database& database, const std::string& select, Read read, const IdType& id, const char* what,
            const char* advice) {
  auto found = database.One(select + " WHERE id = ?", read, id);
  if (!found) {
    Refuse(ErrorCode::kNotFound,
           std::string("no ") + what + " " + id.ToString() + " in this study; " + advice + " (and check -C DIR)");
  }
  return *std::move(found);
}

}  // namespace

Subject ReadSubject(const RowView& row) {
  Subject subject{row.Key<SubjectId>(0), row.Text(1), row.Key<SiteId>(2), {}, {}};
  if (!row.IsNull(3)) subject.consent_given = row.Day(3);
  if (!row.IsNull(4)) subject.consent_withdrawn = row.Day(4);
  return subject;
}

Visit ReadVisit(const RowView& row) { return {row.Key<VisitId>(0), row.Key<SubjectId>(1), row.Text(2)}; }

Device ReadDevice(const RowView& row) {
  return {row.Key<DeviceId>(0), row.Text(1), Unwrap(ParseRigRange(row.Text(2))), row.Text(3), row.Text(4)};
}

CalibrationReference ReadCalibration(const RowView& row) {
  return {row.Key<CalibrationId>(0), row.Key<DeviceId>(1), row.Hash(2), row.Day(3)};
}

Session ReadSession(const RowView& row) {
  Session session;
  session.id = row.Key<SessionId>(0);
  session.subject = row.Key<SubjectId>(1);
  session.visit = row.Key<VisitId>(2);
  session.operator_name = row.Text(3);
  session.opened_at = row.Time(4);
  if (!row.IsNull(5)) session.closed_at = row.Time(5);
  session.site_time_zone = row.Text(6);
  if (!row.IsNull(7)) session.camera_clock_offset_s = static_cast<int>(row.Integer(7));
  if (!row.IsNull(8)) session.day = row.Day(8);
  return session;
}

Capture ReadCapture(const RowView& row) {
  Capture capture;
  capture.id = row.Key<CaptureId>(0);
  capture.session = row.Key<SessionId>(1);
  capture.sha256 = row.Hash(2);
  capture.file_name = row.Text(3);
  capture.media_type = row.Text(4);
  capture.size_bytes = static_cast<std::uint64_t>(row.Integer(5));
  capture.role = Unwrap(CaptureRole::Parse(row.Text(6)));
  capture.body_site = row.Text(7);
  capture.laterality = Unwrap(ParseLaterality(row.Text(8)));
  capture.imported_at = row.Time(9);
  capture.metadata = MetadataFromJson(json::parse(row.Text(10)));
  capture.preflight = PreflightFromJson(json::parse(row.Text(11)));
  return capture;
}

StoredOutline ReadOutline(const RowView& row) {
  return {row.Key<OutlineId>(0), row.Key<CaptureId>(1), row.Hash(2), row.Text(3), row.Time(4), {}};
}

Derived ReadDerivedRow(const RowView& row) {
  Derived derived;
  derived.capture = row.Key<CaptureId>(0);
  derived.kind = row.Text(1);
  derived.media_type = row.Text(2);
  derived.sha256 = row.Hash(3);
  derived.object = row.Hash(4);
  derived.size_bytes = static_cast<std::uint64_t>(row.Integer(5));
  derived.provenance = ProvenanceFromJson(json::parse(row.Text(6)));
  derived.made_at = row.Time(7);
  return derived;
}

Outcome ReadOutcome(const RowView& row) {
  Outcome outcome;
  outcome.id = row.Key<ReportId>(0);
  outcome.capture = row.Key<CaptureId>(1);
  outcome.analysis = row.Text(2);
  outcome.report = Unwrap(AnalysisReportFromJson(json::parse(row.Text(3))));
  if (!row.IsNull(4)) {
    outcome.failure =
        Error{ErrorCodeFrom(row.Text(4)), row.Text(5), json::parse(row.Text(6)).get<std::vector<std::string>>()};
  }
  if (!row.IsNull(7)) outcome.supersedes = row.Key<ReportId>(7);
  outcome.at = row.Time(8);
  return outcome;
}

Subject GetSubject(Database& database, const SubjectId& id) {
  return GetOne(database, kSubjects, ReadSubject, id, "subject", "see 'striae subject list'");
}
Visit GetVisit(Database& database, const VisitId& id) {
  return GetOne(database, kVisits, ReadVisit, id, "visit", "see 'striae session list'");
}
Device GetDevice(Database& database, const DeviceId& id) {
  return GetOne(database, kDevices, ReadDevice, id, "device", "add it with 'striae device add'");
}
Session GetSession(Database& database, const SessionId& id) {
  return GetOne(database, kSessions, ReadSession, id, "session", "see 'striae session list'");
}
Capture GetCapture(Database& database, const CaptureId& id) {
  return GetOne(database, kCaptures, ReadCapture, id, "capture", "see 'striae show SESSION'");
}

std::optional<StoredOutline> FindOutline(Database& database, const ObjectStore& objects, const CaptureId& capture) {
  auto found =
      database.One(std::string(kOutlines) + " WHERE capture_id = ? ORDER BY number DESC LIMIT 1", ReadOutline, capture);
  if (!found) return std::nullopt;
  const auto bytes = Unwrap(objects.Get(found->sha256));
  found->outline = Unwrap(OutlineFromJson({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
  return found;
}

std::int64_t NextNumber(Database& database, const std::string& table, const std::string& parent_column,
                        const std::string& parent) {
  return 1 +
         database.Count("SELECT coalesce(max(number), 0) FROM " + table + " WHERE " + parent_column + " = ?", parent);
}

}  // namespace striae::store::detail
