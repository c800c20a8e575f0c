// A study with one site, and short ways to fill it. Ids and times count up from a fixed start: no clock, no chance.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <sqlite3.h>

#include "store/record.h"
#include "tests/support/temp_dir.h"

namespace striae::testing {

/// Explains itself with the error's text when a Result is an error.
MATCHER(IsOk, "is a success") {
  if (arg) return true;
  *result_listener << arg.error().Describe();
  return false;
}
/// An error of that code whose text has these words: what a person is told.
MATCHER_P2(FailsWith, code, words, "") {
  if (arg) return false;
  *result_listener << ToString(arg.error().code) << ": " << arg.error().Describe();
  return arg.error().code == code && arg.error().Describe().find(words) != std::string::npos;
}

inline Uuid CountedUuid() {
  static std::uint64_t count = 0;
  ++count;
  std::array<std::uint8_t, 16> bytes{};
  for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<std::uint8_t>(count * 2654435761U >> (8 * i));
  return Uuid::FromRandom(bytes);
}
template <typename IdType>
IdType CountedId() {
  return IdType(CountedUuid());
}

/// Each later than the one before by one second.
inline store::Stamp NextStamp() {
  static std::int64_t seconds = 0;
  ++seconds;
  return {{1'777'880'000'000 + 1000 * seconds}, "coordinator", "desk", "Europe/Ljubljana", 120};
}

inline std::span<const std::uint8_t> Bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

class SmallStudy {
 public:
  explicit SmallStudy(const std::string& name = "study") : folder_(dir_ / name), record_(Make(folder_, site_)) {}

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const TempDir& dir() const { return dir_; }
  [[nodiscard]] std::filesystem::path database() const { return folder_ / "study.db"; }
  [[nodiscard]] const SiteId& site() const { return site_; }
  store::Record& record() { return record_; }
  store::Record* operator->() { return &record_; }
  /// Until Reopen the study is open nowhere in this process.
  void Close() { const store::Record closed = std::move(record_); }
  /// Closes the study and opens it again, as the next program would.
  void Reopen() { record_ = *store::Record::Open(folder_, NextStamp()); }

  Subject Enrol(const std::string& pseudonym) {
    const Subject subject{CountedId<SubjectId>(), pseudonym, site_, {}, {}};
    EXPECT_THAT(record_.AddSubject(subject, NextStamp()), IsOk());
    return subject;
  }
  Subject EnrolWithConsent(const std::string& pseudonym) {
    const Subject subject = Enrol(pseudonym);
    EXPECT_THAT(record_.GiveConsent(subject.id, {2026, 5, 1}, NextStamp()), IsOk());
    return *record_.SubjectById(subject.id);
  }
  Session Open(const Subject& subject, const std::string& visit = "V1") {
    const store::Stamp stamp = NextStamp();
    Session session;
    session.id = CountedId<SessionId>();
    session.subject = subject.id;
    session.operator_name = stamp.user;
    session.opened_at = stamp.now;
    session.site_time_zone = "Europe/Ljubljana";
    session.camera_clock_offset_s = -37;
    return *record_.OpenSession(session, visit, CountedId<VisitId>(), stamp);
  }
  static Capture Photograph(const Session& session, const std::string& role = "wound:W1") {
    Capture capture;
    capture.id = CountedId<CaptureId>();
    capture.session = session.id;
    capture.file_name = "DSC_0001.JPG";
    capture.media_type = "image/jpeg";
    capture.role = *CaptureRole::Parse(role);
    return capture;
  }
  Capture Import(const Session& session, const std::string& bytes, const std::string& role = "wound:W1") {
    const auto added = record_.AddCapture(Photograph(session, role), Bytes(bytes), NextStamp());
    EXPECT_THAT(added, IsOk());
    return added->capture;
  }

 private:
  static store::Record Make(const std::filesystem::path& folder, SiteId& site) {
    site = CountedId<SiteId>();
    const Study study{CountedId<StudyId>(), "WND-01", "Healing of leg ulcers", "Example Institute", "Example Centre"};
    auto record = store::Record::Create(folder, study, {site, "LJ", "Example Clinic", "Europe/Ljubljana"},
                                        CountedUuid(), NextStamp());
    EXPECT_THAT(record, IsOk());
    return *std::move(record);
  }

  TempDir dir_;
  SiteId site_;
  std::filesystem::path folder_;
  store::Record record_;
};

/// SQL run past the record, as someone with the sqlite3 program could: "" or SQLite's complaint.
inline std::string RawSql(const std::filesystem::path& database, const std::string& sql) {
  sqlite3* connection = nullptr;
  std::string complaint;
  if (sqlite3_open(database.c_str(), &connection) == SQLITE_OK) {
    char* message = nullptr;
    sqlite3_exec(connection, sql.c_str(), nullptr, nullptr, &message);
    if (message != nullptr) complaint = message;
    sqlite3_free(message);
  } else {
    complaint = "cannot open";
  }
  sqlite3_close(connection);
  return complaint;
}

/// A report with one good and one flagged number, made from the capture's photograph.
inline AnalysisReport WoundReport(const Capture& capture, double volume_ml) {
  AnalysisReport report;
  report.analysis = "wound";
  report.version = "1";
  report.provenance.version = "0.1.0";
  report.provenance.inputs = {{"photograph", capture.sha256}};
  report.provenance.parameters = {{"ring_mm", 10.0}};
  report.measurements.push_back({"volume",
                                 {"SCT", "118565006", "Volume"},
                                 {{"DCM", "0", "Volume"}},
                                 volume_ml,
                                 "mL",
                                 0.25,
                                 Measurement::Status::kOk,
                                 ""});
  report.measurements.push_back({"depth_max",
                                 {"SCT", "131197000", "Depth"},
                                 {},
                                 4.5,
                                 "mm",
                                 0.5,
                                 Measurement::Status::kFlagged,
                                 "a hole at the deepest place"});
  report.details = {{"axes_source", "camera"}};
  return report;
}

}  // namespace striae::testing
