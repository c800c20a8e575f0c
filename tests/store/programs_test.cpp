// Two programs at one study, and a program that is killed.
#include <csignal>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

#include "store/detail/database.h"
#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

using store::Record;
constexpr std::size_t kIdLength = 36;

TEST(TwoPrograms, WriteInTurnAndSeeEachOthersRows) {
  SmallStudy study;
  constexpr int kEach = 10;
  const auto write = [&](const std::string& letter, std::vector<Subject> subjects) {
    auto record = Record::Open(study.folder(), {{1'777'881'000'000}, "coordinator", "desk", "", 0});
    for (int i = 0; i < kEach; ++i) {
      Subject& subject = subjects[static_cast<std::size_t>(i)];
      subject.pseudonym = letter + std::to_string(i);
      EXPECT_THAT(record->AddSubject(subject, {{1'777'881'000'000 + i}, "coordinator", "desk", "", 0}), IsOk());
    }
  };
  const auto some = [&] {
    std::vector<Subject> subjects;
    for (int i = 0; i < kEach; ++i) subjects.push_back({CountedId<SubjectId>(), "", study.site(), {}, {}});
    return subjects;
  };
  std::thread first(write, "A", some());
  std::thread second(write, "B", some());
  first.join();
  second.join();
  EXPECT_EQ(study->Subjects()->size(), 2U * kEach);
  EXPECT_TRUE(study->Check()->Passed()) << "one chain, whoever wrote";
}

TEST(TwoPrograms, OneWaitsForTheOther) {
  SmallStudy study;
  store::detail::Database other(study.database(), false);
  other.Execute("BEGIN IMMEDIATE");
  std::thread release([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    other.Execute("COMMIT");
  });
  EXPECT_THAT(study->AddSubject({CountedId<SubjectId>(), "S001", study.site(), {}, {}}, NextStamp()), IsOk());
  release.join();
}

TEST(TwoPrograms, OneThatNeverFinishesIsNamedAndReadingGoesOn) {
  SmallStudy study;
  store::detail::Database other(study.database(), false);
  other.Execute("BEGIN IMMEDIATE");
  store::detail::Database impatient(study.database(), false);
  impatient.SetBusyTimeout(std::chrono::milliseconds(50));
  const Status busy = store::detail::Guarded([&] { impatient.Execute("BEGIN IMMEDIATE"); });
  EXPECT_THAT(busy, FailsWith(ErrorCode::kIo, "another program is writing"));
  EXPECT_THAT(study->Subjects(), IsOk());
}

/// What was said until the first photograph was acknowledged, so that a busy machine cannot make the test an empty one.
std::string ReadFirst(int pipe) {
  std::string text;
  char byte = 0;
  while (text.size() < kIdLength && ::read(pipe, &byte, 1) == 1) text += byte;
  return text;
}

/// Imports photographs one after the other, telling each success through the pipe, until it is killed.
[[noreturn]] void ImportForever(const std::filesystem::path& folder, const Session& session, int pipe) {
  auto record = Record::Open(folder, NextStamp());
  for (int i = 0; record; ++i) {
    const std::string photo = "photo " + std::to_string(i) + std::string(20'000, 'x');
    const auto added = record->AddCapture(SmallStudy::Photograph(session), Bytes(photo), NextStamp());
    if (!added) break;
    const auto text = added->capture.id.ToString();
    if (::write(pipe, text.data(), text.size()) < 0) break;
  }
  ::_exit(1);
}

std::string ReadAll(int pipe) {
  std::string text;
  char block[4096];
  for (ssize_t count = 0; (count = ::read(pipe, block, sizeof block)) > 0;) {
    text.append(block, static_cast<std::size_t>(count));
  }
  return text;
}

TEST(AKilledProgram, LosesNothingThatItHadAcknowledged) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  // Moments spread over several imports (each takes a few milliseconds), so that different steps are hit; in every
  // second round not before the first one was acknowledged.
  for (int round = 0; round < 8; ++round) {
    study.Close();  // SQLite does not allow a connection to be carried through fork()
    int pipe_ends[2];
    ASSERT_EQ(::pipe(pipe_ends), 0);
    const pid_t child = ::fork();
    if (child == 0) ImportForever(study.folder(), session, pipe_ends[1]);
    ::close(pipe_ends[1]);
    std::string acknowledged = round % 2 == 1 ? ReadFirst(pipe_ends[0]) : "";
    std::this_thread::sleep_for(std::chrono::milliseconds(30 + 7 * round));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    acknowledged += ReadAll(pipe_ends[0]);
    ::close(pipe_ends[0]);
    study.Reopen();
    for (std::size_t at = 0; at + kIdLength <= acknowledged.size(); at += kIdLength) {
      const auto capture = study->CaptureById(*CaptureId::Parse(acknowledged.substr(at, kIdLength)));
      ASSERT_THAT(capture, IsOk());
      EXPECT_THAT(study->objects().Get(capture->sha256), IsOk());
    }
    const auto report = study->Check();
    EXPECT_TRUE(report->Passed()) << (report->findings.empty() ? "" : report->findings.front().what);
  }
  EXPECT_GT(study->Captures(session.id)->size(), 0U);
}

}  // namespace
}  // namespace striae::testing
