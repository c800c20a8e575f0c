// The record at the size of a large study: 10,000 photographs of 500 subjects. Prints what the questions of the day
// take, and what SQLite itself takes to insert as many rows of the same size.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <sqlite3.h>
#include <sys/resource.h>

#include "store/check.h"
#include "store/record.h"

namespace {

using namespace striae;
using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

double Since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

template <typename IdType>
IdType NextId() {
  static std::uint64_t count = 0;
  std::array<std::uint8_t, 16> bytes{};
  ++count;
  for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<std::uint8_t>(count * 0x9E3779B97F4A7C15ULL >> (8 * i));
  return IdType(Uuid::FromRandom(bytes));
}

store::Stamp Now() {
  static std::int64_t seconds = 0;
  return {{1'777'880'000'000 + 1000 * ++seconds}, "bench", "bench", "", 0};
}

template <typename T>
T Must(Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "%s\n", result.error().Describe().c_str());
    std::exit(1);
  }
  return *std::move(result);
}

long PeakKib() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

/// Opens the study as a command does, then asks.
template <typename Ask>
void Print(const fs::path& study, const char* what, Ask ask) {
  const auto start = Clock::now();
  auto record = Must(store::Record::Open(study, Now()));
  ask(record);
  std::printf("%-22s %8.3f s\n", what, Since(start));
}

/// As many rows of that many bytes in one transaction, with SQLite alone.
double BulkInsert(const fs::path& file, int rows, const std::string& text) {
  sqlite3* database = nullptr;
  sqlite3_open(file.c_str(), &database);
  sqlite3_exec(database, "CREATE TABLE t (id INTEGER PRIMARY KEY, text TEXT); BEGIN", nullptr, nullptr, nullptr);
  sqlite3_stmt* insert = nullptr;
  sqlite3_prepare_v2(database, "INSERT INTO t (text) VALUES (?)", -1, &insert, nullptr);
  const auto start = Clock::now();
  for (int i = 0; i < rows; ++i) {
    sqlite3_bind_text(insert, 1, text.c_str(), -1, SQLITE_STATIC);
    sqlite3_step(insert);
    sqlite3_reset(insert);
  }
  sqlite3_finalize(insert);
  sqlite3_exec(database, "COMMIT", nullptr, nullptr, nullptr);
  const double seconds = Since(start);
  sqlite3_close(database);
  return seconds;
}

}  // namespace

int main(int argc, char** argv) {
  const int subjects = argc > 2 ? std::atoi(argv[2]) : 500;
  constexpr int kEach = 20;
  const fs::path folder = fs::path(argc > 1 ? argv[1] : ".") / "record-bench";
  fs::remove_all(folder);
  const fs::path study = folder / "study";
  const Site site{NextId<SiteId>(), "LJ", "Example Clinic", "Europe/Ljubljana"};
  {
    const Study about{NextId<StudyId>(), "WND-01", "Bench", "Example Institute", ""};
    auto record = Must(store::Record::Create(study, about, site, NextId<StudyId>().uuid(), Now()));
    const std::string padding(20'000, 'x');
    const auto start = Clock::now();
    for (int s = 0; s < subjects; ++s) {
      const Subject subject{NextId<SubjectId>(), "S" + std::to_string(1000 + s), site.id, {}, {}};
      if (!record.AddSubject(subject, Now()) || !record.GiveConsent(subject.id, {2026, 5, 1}, Now())) return 1;
      Session session;
      session.id = NextId<SessionId>();
      session.subject = subject.id;
      session.operator_name = "bench";
      session.opened_at = Now().now;
      Must(record.OpenSession(session, "V1", NextId<VisitId>(), Now()));
      for (int c = 0; c < kEach; ++c) {
        Capture capture;
        capture.id = NextId<CaptureId>();
        capture.session = session.id;
        capture.file_name = "DSC_0001.JPG";
        capture.media_type = "image/jpeg";
        capture.role = *CaptureRole::Parse("wound:W1");
        const std::string bytes = std::to_string(s * kEach + c) + padding;
        const auto added = Must(
            record.AddCapture(capture, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, Now()));
        AnalysisReport report;
        report.analysis = "wound";
        report.version = "1";
        report.measurements.push_back(
            {"volume", {"SCT", "118565006", "Volume"}, {}, 1.5, "mL", 0.1, Measurement::Status::kOk, ""});
        Must(record.AddReport(NextId<ReportId>(), added.capture.id, report, Now()));
      }
      if (s == subjects / 10) std::printf("peak memory after a tenth: %ld KiB\n", PeakKib());
    }
    const int rows = subjects * kEach;
    const double seconds = Since(start);
    const double bulk = BulkInsert(folder / "bulk.db", 2 * 4 * rows, std::string(700, 'x'));
    std::printf("peak memory at the end:   %ld KiB\n", PeakKib());
    std::printf("%d photographs of 20 kB with a report each, every one synced: %.1f s, %.2f ms each\n", rows, seconds,
                1000 * seconds / rows);
    std::printf("SQLite's own insert of as many rows in one transaction: %.2f s, %.3f ms a photograph\n", bulk,
                1000 * bulk / rows);
  }
  Print(study, "status", [](store::Record& record) { Must(record.GetOverview()); });
  Print(study, "session list", [](store::Record& record) { Must(record.Sessions()); });
  Print(study, "results", [](store::Record& record) { Must(record.Results()); });
  Print(study, "check", [](store::Record& record) {
    if (!Must(store::Check(record, {})).findings.empty()) std::exit(1);
  });
  std::printf("peak memory with the check: %ld KiB\n", PeakKib());
  fs::remove_all(folder);
  return 0;
}
