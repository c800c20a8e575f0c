#include "tests/bench/record_study.h"

#include <chrono>
#include <cstring>
#include <string>

#include <sys/resource.h>

#include "store/visits.h"

namespace striae::bench {
namespace {

constexpr int kVisits = 4, kPhotographs = 5;
constexpr std::size_t kPhotographBytes = 20'000;

template <typename IdType>
IdType NextId() {
  static std::uint64_t count = 0;
  std::array<std::uint8_t, 16> bytes{};
  ++count;
  for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<std::uint8_t>(count * 0x9E3779B97F4A7C15ULL >> (8 * i));
  return IdType(Uuid::FromRandom(bytes));
}

long PeakKib() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

AnalysisReport Numbers(const Sha256& photograph) {
  static const char* const names[] = {"volume",    "proud_volume", "area",       "bed_area", "perimeter",
                                      "depth_max", "depth_p95",    "depth_mean", "length",   "width"};
  AnalysisReport report;
  report.analysis = "wound";
  report.version = "1";
  report.provenance.version = "bench";
  report.provenance.inputs = {{"photograph", photograph}, {"surface", photograph}, {"outline", photograph}};
  for (const char* name : names) {
    report.measurements.push_back({name,
                                   {"SCT", "118565006", "Volume"},
                                   {{"UMLS", "C0449468", "Volume"}},
                                   1.2345678901,
                                   "mL",
                                   0.0123456789,
                                   Measurement::Status::kOk,
                                   ""});
  }
  return report;
}

/// Fills one visit of one subject.
void Photograph(store::Record& record, const Subject& subject, int visit, LargeStudy& made) {
  Session session;
  session.id = NextId<SessionId>();
  session.subject = subject.id;
  session.operator_name = "bench";
  session.opened_at = NextStamp().now;
  session.site_time_zone = "Europe/Ljubljana";
  session.day = Date{2026, 5, 4 + 7 * visit};
  Must(record.OpenSession(session, "V" + std::to_string(visit + 1), NextId<VisitId>(), NextStamp()));
  for (int i = 0; i < kPhotographs; ++i) {
    const auto added = Must(
        record.AddCapture(NewCapture(session.id), PhotographBytes(made.captures++, kPhotographBytes), NextStamp()));
    const AnalysisReport report = Numbers(added.capture.sha256);
    Must(record.AddReport(NextId<ReportId>(), added.capture.id, report, NextStamp()));
    made.measurements += static_cast<int>(report.measurements.size());
  }
  Must(record.CloseSession(session.id, NextStamp()));
}

}  // namespace

store::Stamp NextStamp() {
  static std::int64_t seconds = 0;
  return {{1'777'880'000'000 + 1000 * ++seconds}, "bench", "bench", "Europe/Ljubljana", 120};
}

std::vector<std::uint8_t> PhotographBytes(int number, std::size_t size) {
  std::vector<std::uint8_t> bytes(size, 'x');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

Capture NewCapture(const SessionId& session) {
  Capture capture;
  capture.id = NextId<CaptureId>();
  capture.session = session;
  capture.file_name = "DSC_0001.JPG";
  capture.media_type = "image/jpeg";
  capture.role = *CaptureRole::Parse("wound:W1");
  capture.body_site = "calf";
  PhotoMetadata& m = capture.metadata;
  m.make = "NIKON CORPORATION";
  m.model = "NIKON D90";
  m.body_serial = "6123456";
  m.lens = "AF NIKKOR 50mm f/1.8D";
  m.exposure_s = 0.005;
  m.f_number = 11;
  m.iso = 400;
  m.flash_fired = true;
  m.width_px = 4288;
  m.height_px = 2848;
  m.taken_at_camera_clock = "2026:05:04 07:08:09.12";
  for (const char* item : {"camera", "picture size", "flash", "focal length", "exposure time", "aperture", "ISO",
                           "focus mode", "focus distance"}) {
    capture.preflight.push_back({item, PreflightItem::State::kOk, "as expected", "as the protocol says", ""});
  }
  return capture;
}

LargeStudy MakeLargeStudy(const std::filesystem::path& folder, int subjects) {
  LargeStudy made;
  const Site site{NextId<SiteId>(), "LJ", "Example Clinic", "Europe/Ljubljana"};
  const Study study{NextId<StudyId>(), "WND-01", "Bench", "Example Institute", ""};
  auto record = Must(store::Record::Create(folder, study, site, NextId<StudyId>().uuid(), NextStamp()));
  for (int visit = 0; visit < kVisits; ++visit) {
    Must(store::PlanVisit(
        record, {NextId<store::PlannedVisitId>(), "V" + std::to_string(visit + 1), {}, 7 * visit, -3, 3}, NextStamp()));
  }
  const auto start = std::chrono::steady_clock::now();
  for (int s = 0; s < subjects; ++s) {
    const Subject subject{NextId<SubjectId>(), "S" + std::to_string(1000 + s), site.id, {}, {}};
    Must(record.AddSubject(subject, NextStamp()));
    Must(record.GiveConsent(subject.id, {2026, 5, 1}, NextStamp()));
    for (int visit = 0; visit < kVisits; ++visit) Photograph(record, subject, visit, made);
    if (s == subjects / 10) made.peak_kib_at_a_tenth = PeakKib();
  }
  made.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  made.peak_kib = PeakKib();
  return made;
}

}  // namespace striae::bench
