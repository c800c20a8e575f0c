// The record at the size of a large study: 10,000 photographs of 500 subjects with ten numbers each. Prints what the
// questions of the day take as whole programs, beside what SQLite itself takes to read the rows that they print, and
// what import takes, beside its parts: the disk and the hash, SQLite.
#include <algorithm>
#include <chrono>
#include <string>

#include <fcntl.h>
#include <spawn.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "store/check.h"
#include "tests/bench/record_study.h"

namespace {

using namespace striae;
using namespace striae::bench;
using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

double Since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

struct Took {
  double seconds = 1e9;
  long peak_kib = 0;
};

/// The best of three runs of the program; what it prints is thrown away.
Took RunOn(const fs::path& study, std::vector<std::string> words) {
  words.insert(words.begin(), {STRIAE_PROGRAM, "-C", study.string()});
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  Took best;
  for (int i = 0; i < 3; ++i) {
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    const auto start = Clock::now();
    pid_t child = 0;
    int status = 1;
    rusage usage{};
    if (::posix_spawn(&child, pointers[0], &files, nullptr, pointers.data(), environ) != 0 ||
        ::wait4(child, &status, 0, &usage) < 0 || status != 0) {
      std::fprintf(stderr, "%s failed\n", words[3].c_str());
      std::exit(1);
    }
    best.seconds = std::min(best.seconds, Since(start));
    best.peak_kib = usage.ru_maxrss;
    posix_spawn_file_actions_destroy(&files);
  }
  return best;
}

/// SQLite alone reads every row of the query and its bytes: the least that a program which prints them can take.
double ReadAlone(const fs::path& study, const char* sql) {
  double best = 1e9;
  for (int i = 0; i < 3; ++i) {
    const auto start = Clock::now();
    sqlite3* database = nullptr;
    sqlite3_stmt* select = nullptr;
    sqlite3_open_v2((study / "study.db").c_str(), &database, SQLITE_OPEN_READWRITE, nullptr);
    if (sqlite3_prepare_v2(database, sql, -1, &select, nullptr) != SQLITE_OK) std::exit(1);
    std::size_t bytes = 0;
    while (sqlite3_step(select) == SQLITE_ROW) {
      for (int column = 0; column < sqlite3_column_count(select); ++column) {
        sqlite3_column_text(select, column);
        bytes += static_cast<std::size_t>(sqlite3_column_bytes(select, column));
      }
    }
    sqlite3_finalize(select);
    sqlite3_close(database);
    if (bytes == 0) std::exit(1);
    best = std::min(best, Since(start));
  }
  return best;
}

/// Rows of that many bytes with SQLite alone: all in one transaction, or each in one of its own that is synced.
double InsertAlone(const fs::path& file, int rows, std::size_t bytes, bool each_synced) {
  const std::string text(bytes, 'x');
  sqlite3* database = nullptr;
  sqlite3_open(file.c_str(), &database);
  sqlite3_exec(database,
               "PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; CREATE TABLE t (id INTEGER PRIMARY KEY, text TEXT)",
               nullptr, nullptr, nullptr);
  if (!each_synced) sqlite3_exec(database, "BEGIN", nullptr, nullptr, nullptr);
  sqlite3_stmt* insert = nullptr;
  sqlite3_prepare_v2(database, "INSERT INTO t (text) VALUES (?)", -1, &insert, nullptr);
  const auto start = Clock::now();
  for (int i = 0; i < rows; ++i) {
    sqlite3_bind_text(insert, 1, text.c_str(), -1, SQLITE_STATIC);
    sqlite3_step(insert);
    sqlite3_reset(insert);
  }
  sqlite3_finalize(insert);
  if (!each_synced) sqlite3_exec(database, "COMMIT", nullptr, nullptr, nullptr);
  const double seconds = Since(start);
  sqlite3_close(database);
  return seconds;
}

void Questions(const fs::path& tenth, const fs::path& study) {
  const double measurements = ReadAlone(
      study,
      "SELECT m.*, o.*, e.*, s.*, v.* FROM measurement m JOIN outcome o ON o.id = m.outcome_id JOIN capture c ON "
      "c.id = o.capture_id JOIN session e ON e.id = c.session_id JOIN subject s ON s.id = e.subject_id JOIN "
      "visit v ON v.id = e.visit_id");
  const double sessions = ReadAlone(study, "SELECT * FROM session");
  const double captures = ReadAlone(study, "SELECT * FROM capture");
  const struct {
    const char* name;
    std::vector<std::string> words;
    double alone;
  } questions[] = {{"status", {"status"}, captures},
                   {"session list", {"session", "list"}, sessions},
                   {"session list --json", {"session", "list", "--json"}, sessions},
                   {"visit list", {"visit", "list"}, sessions},
                   {"results", {"results"}, measurements},
                   {"results --json", {"results", "--json"}, measurements},
                   {"results --subject S1001", {"results", "--subject", "S1001"}, measurements}};
  std::printf("%-26s %8s %12s %10s %18s\n", "", "seconds", "SQLite alone", "ratio", "peak MiB (a tenth)");
  for (const auto& question : questions) {
    const Took small = RunOn(tenth, question.words), took = RunOn(study, question.words);
    std::printf("%-26s %8.3f %12.3f %10.1f %10ld (%ld)\n", question.name, took.seconds, question.alone,
                took.seconds / question.alone, took.peak_kib / 1024, small.peak_kib / 1024);
  }
}

/// Photographs of a D90's size into one session, one after another, and the parts of that.
void Import(const fs::path& folder) {
  constexpr int kCount = 60;
  constexpr std::size_t kBytes = 5'000'000;
  MakeLargeStudy(folder / "import", 1);
  auto record = Must(store::Record::Open(folder / "import", NextStamp()));
  const auto sessions = Must(record.Sessions());
  Must(record.ReopenSession(sessions.front().id, "bench", NextStamp()));
  double whole = 0, object = 0;
  for (int i = 0; i < kCount; ++i) {
    const auto bytes = PhotographBytes(1'000'000 + i, kBytes), others = PhotographBytes(2'000'000 + i, kBytes);
    auto start = Clock::now();
    Must(record.AddCapture(NewCapture(sessions.front().id), bytes, NextStamp()));
    whole += Since(start);
    start = Clock::now();
    Must(record.objects().Put(others));
    object += Since(start);
  }
  // A photograph is four rows of about 1.2 kB: object and capture, and the audit row of each.
  const double commit = InsertAlone(folder / "commits.db", kCount, 4800, true);
  std::printf(
      "\nimport of %d photographs of %.0f MB: %.1f ms each; hash, file and fsync alone %.1f ms (%.0f %%), the "
      "record's rows %.1f ms (%.0f %%); a synced insert of SQLite alone %.1f ms\n",
      kCount, kBytes / 1e6, 1000 * whole / kCount, 1000 * object / kCount, 100 * object / whole,
      1000 * (whole - object) / kCount, 100 * (whole - object) / whole, 1000 * commit / kCount);
}

}  // namespace

int main(int argc, char** argv) {
  const int subjects = argc > 2 ? std::atoi(argv[2]) : 500;
  const fs::path folder = fs::path(argc > 1 ? argv[1] : ".") / "record-bench";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const fs::path tenth = folder / "tenth", study = folder / "study";
  MakeLargeStudy(tenth, subjects / 10);
  const LargeStudy made = MakeLargeStudy(study, subjects);
  // A photograph and its numbers: the rows of object, capture, outcome and ten measurements, and the audit row of each.
  const double bulk = InsertAlone(folder / "bulk.db", 26 * made.captures, 700, false);
  std::printf("%d photographs of 20 kB, %d numbers, every one synced: %.0f s, %.1f ms a photograph with its numbers\n",
              made.captures, made.measurements, made.seconds, 1000 * made.seconds / made.captures);
  std::printf("SQLite's own insert of as many rows in one transaction: %.2f s, %.2f ms a photograph\n", bulk,
              1000 * bulk / made.captures);
  std::printf("peak memory while writing: %.1f MiB after a tenth, %.1f MiB at the end\n\n",
              static_cast<double>(made.peak_kib_at_a_tenth) / 1024, static_cast<double>(made.peak_kib) / 1024);
  Questions(tenth, study);
  Import(folder);
  const Took check = RunOn(study, {"check"});
  std::printf("check of all: %.1f s, %ld MiB (a tenth: %ld MiB)\n", check.seconds, check.peak_kib / 1024,
              RunOn(tenth, {"check"}).peak_kib / 1024);
  if (argc <= 3) fs::remove_all(folder);  // a third word keeps it
  return 0;
}
