// The study record: a folder with study.db (SQLite) and objects/. All that is written passes through here; each change
// and its audit rows are one transaction.
//
// Ids of new entities and the time come from the caller (app/: NewId, NewStamp). One Record is used by one thread;
// several programs may have the same study open (one writes at a time, the others wait up to ten seconds).
// Errors: kNotFound for an id that is not in the record, kRecordRefused where a rule of the study says no,
// kRecordDamaged where the record contradicts itself, kIo where the disk does not let it. On an error nothing changed.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/result.h"
#include "core/study.h"
#include "store/audit.h"
#include "store/entries.h"
#include "store/objects.h"
#include "store/stamp.h"

namespace striae::store {

namespace detail {
struct Access;
}

class Record {
 public:
  /// A new study in `folder`, which must be empty or absent. `origin` (16 random bytes) names this copy of the study.
  static Result<Record> Create(const std::filesystem::path& folder, const Study& study, const Site& site,
                               const Uuid& origin, const Stamp& stamp);
  /// kNotFound where there is no study; kRecordRefused for one written by a newer Striae. An older one is copied to
  /// study.db.before-<version> first and then brought up to date.
  static Result<Record> Open(const std::filesystem::path& folder, const Stamp& stamp);
  Record(Record&&) noexcept;
  Record& operator=(Record&&) noexcept;
  ~Record();

  [[nodiscard]] const std::filesystem::path& folder() const;
  [[nodiscard]] const ObjectStore& objects() const;

  /// Called once when another program's writing makes this one wait (up to ten seconds in all).
  void WhenBusy(std::function<void()> tell);

  // Study and sites.
  Result<Study> GetStudy();
  Result<std::vector<Site>> Sites();

  // Subjects, consent, visits. A pseudonym has 1 to 32 letters, digits, '-', '_' or '.'.
  Status AddSubject(const Subject& subject, const Stamp& stamp);  ///< consent is given separately
  Result<std::vector<Subject>> Subjects();
  Result<Subject> SubjectById(const SubjectId& id);
  Result<Subject> SubjectByPseudonym(std::string_view pseudonym);
  /// Consent may be given again after a withdrawal. Both keep their history.
  Status GiveConsent(const SubjectId& subject, const Date& given, const Stamp& stamp);
  Status WithdrawConsent(const SubjectId& subject, const Date& withdrawn, const std::string& reason,
                         const Stamp& stamp);
  Result<std::vector<Visit>> Visits(const SubjectId& subject);

  // Devices and their calibrations.
  Status AddDevice(const Device& device, const Stamp& stamp);
  Result<std::vector<Device>> Devices();
  /// The device of that body serial; with both ranges on one body, `range` says which.
  Result<Device> DeviceBySerial(std::string_view serial, std::optional<RigRange> range = std::nullopt);
  /// Keeps the calibration file (checked as CalibrationFromJson does) in force from a day on.
  Result<CalibrationReference> AddCalibration(const CalibrationId& id, const DeviceId& device,
                                              std::span<const std::uint8_t> json_bytes, const Date& valid_from,
                                              const Stamp& stamp);
  Result<std::vector<CalibrationReference>> Calibrations(const DeviceId& device);
  /// The newest calibration in force on that day; kRecordRefused when there is none.
  Result<CalibrationReference> CalibrationOn(const DeviceId& device, const Date& day);

  // Sessions. `session.visit` is ignored: the visit of that name is used, or made with `new_visit`. What deviates from
  // the plan is noted about the session in the same transaction.
  Result<Session> OpenSession(Session session, std::string_view visit_name, const VisitId& new_visit,
                              const Stamp& stamp, const std::string& deviation = "");
  Status CloseSession(const SessionId& id, const Stamp& stamp);
  /// Lets photographs in again, with a reason.
  Status ReopenSession(const SessionId& id, const std::string& reason, const Stamp& stamp);
  Result<Session> SessionById(const SessionId& id);
  Result<std::vector<Session>> Sessions(std::optional<SubjectId> subject = std::nullopt);
  Result<Visit> VisitById(const VisitId& id);

  // Captures.
  /// Whether a photograph may be added now: the session exists and is open, the subject's consent is active. Ask
  /// before the shutter is released.
  Status MayCapture(const SessionId& session);
  struct Added {
    Capture capture;
    bool already_there = false;  ///< the same photograph was in this session before; nothing was added
  };
  /// Keeps the photograph. sha256, size and imported_at are filled in here. Besides MayCapture's rules: the same bytes
  /// under another subject, or in another session unless it is the neutral pose, are refused and the place named. The
  /// same photograph again in the same session adds nothing; a role is set when it had none.
  Result<Added> AddCapture(const Capture& capture, std::span<const std::uint8_t> bytes, const Stamp& stamp);
  Status SetRole(const CaptureId& id, const CaptureRole& role, const std::string& reason, const Stamp& stamp);
  Result<Capture> CaptureById(const CaptureId& id);
  Result<std::vector<Capture>> Captures(const SessionId& session);
  /// All captures with these bytes (more than one only for a neutral pose used in several sessions).
  Result<std::vector<Capture>> CapturesOf(const Sha256& sha256);

  // Outlines: append-only, the newest is in force.
  /// kRecordRefused when its image_sha256 is another photograph's; kBadFile when it leaves the photograph.
  Result<StoredOutline> AddOutline(const OutlineId& id, const CaptureId& capture, const Outline& outline,
                                   const Stamp& stamp);
  Result<std::optional<StoredOutline>> LatestOutline(const CaptureId& capture);

  // Processing. For each work item: AddDerived for surface and previews, then AddReport or AddFailure.
  /// Captures with a role, of one session or all.
  Result<std::vector<WorkItem>> Work(std::optional<SessionId> session = std::nullopt);
  /// Keeps a derived file (kind "surface" is compressed). capture, kind, media_type and provenance are taken from
  /// `derived`, the rest is filled in. The same bytes with the same kind and capture again add nothing.
  Result<Derived> AddDerived(const Derived& derived, std::span<const std::uint8_t> bytes, const Stamp& stamp);
  Result<std::vector<Derived>> DerivedOf(const CaptureId& capture);
  Result<std::optional<Derived>> LatestDerived(const CaptureId& capture, std::string_view kind);
  /// The file itself, decompressed and hashed again.
  Result<std::vector<std::uint8_t>> ReadDerived(const Derived& derived);
  /// Numbers. Supersedes the capture's outcome in force of the same analysis. Values must be finite.
  Result<Outcome> AddReport(const ReportId& id, const CaptureId& capture, const AnalysisReport& report,
                            const Stamp& stamp);
  /// No numbers, and why. `report` gives analysis, version and provenance; its measurements must be empty.
  Result<Outcome> AddFailure(const ReportId& id, const CaptureId& capture, const AnalysisReport& report,
                             const Error& failure, const Stamp& stamp);
  /// Oldest first, superseded ones included.
  Result<std::vector<Outcome>> Outcomes(const CaptureId& capture);
  Result<Outcome> OutcomeById(const ReportId& id);
  /// Ordered by subject, session, capture and the order within the report.
  Result<std::vector<ResultRow>> Results(const ResultFilter& filter = {});

  // The record about itself.
  Result<Overview> GetOverview();
  /// What a name given by a person stands for: a pseudonym, a device serial, an id or its first eight or more
  /// characters, or a SHA-256 (entity "object"). kNotFound, or kUsage when it fits several.
  struct Found {
    std::string entity;  ///< "subject", "session", "capture", "outcome", "measurement", ...
    std::string id;
  };
  Result<Found> Find(std::string_view name);
  /// Everything about one thing (named as for Find) and where it leads. {"type", "id", ...}.
  Result<nlohmann::json> Describe(std::string_view id);
  /// Audit rows about one thing (named as for Find), oldest first.
  Result<std::vector<AuditRow>> History(std::string_view entity);
  Result<AuditHead> Head();
  /// Verifies the audit chain, that every row is as its trail says, foreign keys, SQLite's own structure, and that
  /// each object is there and unaltered. `expected`: a head noted earlier must still be part of the chain.
  Result<CheckReport> Check(std::optional<AuditHead> expected = std::nullopt);

  struct Impl;

 private:
  friend struct detail::Access;
  explicit Record(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace striae::store
