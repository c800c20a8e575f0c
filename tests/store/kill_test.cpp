// kill -9 at any step of any change: what was acknowledged is there, and the rest is settled by a repair.
//
// The child of a fork works with the record and is killed at its n-th call that changes a file.
#include <csignal>
#include <random>

#include <sys/wait.h>
#include <unistd.h>

#include "store/backup.h"
#include "store/check.h"
#include "store/identity.h"
#include "store/merge.h"
#include "store/repair.h"
#include "tests/store/findings.h"
#include "tests/support/files.h"
#include "tests/support/killed_calls.h"

namespace striae::testing {
namespace {

namespace fs = std::filesystem;
constexpr store::IdentityCost kQuick{1, 8192};
const std::string kPassphrase = "four random words here";

/// What the parent knows for sure: the child has said so before it was killed.
struct Said {
  bool done = false;
  int signal = 0;
};

/// Runs `work` in a child that is killed at its n-th call that changes a file.
template <typename Work>
Said KilledAt(long n, Work work) {
  int pipe_ends[2];
  EXPECT_EQ(::pipe(pipe_ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    striae_test_calls_left = n;
    work();
    striae_test_calls_left = -1;
    (void)::write(pipe_ends[1], "x", 1);
    ::_exit(0);
  }
  ::close(pipe_ends[1]);
  char byte = 0;
  Said said;
  said.done = ::read(pipe_ends[0], &byte, 1) == 1;
  ::close(pipe_ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  said.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  return said;
}

/// A study, closed between the children (SQLite's connections do not cross a fork).
class Killed {
 public:
  Killed() {
    subject_ = study_.EnrolWithConsent("S001");
    session_ = study_.Open(subject_);
    first_ = study_.Import(session_, "acknowledged before");
    study_.Close();
    store::RestoreOptions branch;
    branch.branch = CountedUuid();
    EXPECT_THAT(store::Restore(study_.folder(), study_.dir() / "branch", branch, NextStamp()), IsOk());
    auto other = store::Record::Open(study_.dir() / "branch", NextStamp());
    EXPECT_THAT(other->AddCapture(SmallStudy::Photograph(session_), Bytes("of the branch"), NextStamp()), IsOk());
    EXPECT_THAT(WriteIdentities(Identity(), {Person("before")}, kPassphrase, {}, kQuick), IsOk());
  }

  /// One round: something is done and killed; then everything that must hold is looked at.
  void Round(int what, long n, int round) {
    const fs::path folder = study_.folder();
    const fs::path backup = study_.dir() / ("backup" + std::to_string(round));
    const std::string photo = "photo " + std::to_string(round) + std::string(5000, 'x');
    const Subject subject{CountedId<SubjectId>(), "R" + std::to_string(round), study_.site(), {}, {}};
    const Capture capture = SmallStudy::Photograph(session_);
    Session session = session_;
    session.id = CountedId<SessionId>();
    const auto visit = CountedId<VisitId>();
    const auto report = CountedId<ReportId>();
    const store::Stamp stamp = NextStamp();
    const Said said = KilledAt(n, [&] {
      if (what == 6) {
        (void)WriteIdentities(Identity(), {Person("after " + std::to_string(round))}, kPassphrase, {}, kQuick);
        return;
      }
      auto record = store::Record::Open(folder, stamp);
      if (what == 0) (void)record->AddCapture(capture, Bytes(photo), stamp);
      if (what == 1) (void)record->AddSubject(subject, stamp);
      if (what == 2) (void)record->OpenSession(session, "V" + std::to_string(round), visit, stamp);
      if (what == 3) (void)record->AddReport(report, first_.id, WoundReport(first_, 1.0 + round), stamp);
      if (what == 4) {
        auto other = store::Record::Open(study_.dir() / "branch", stamp);
        (void)store::Merge(*record, *other, {}, stamp);
      }
      if (what == 5) (void)store::Backup(*record, backup, {}, stamp);
      if (what == 7) {
        (void)record->objects().Put(Bytes("left over " + photo));
        (void)store::Repair(*record, {}, stamp);
      }
    });
    ASSERT_TRUE(said.done || said.signal == SIGKILL);
    killed_ += said.done ? 0 : 1;
    SCOPED_TRACE("what " + std::to_string(what) + ", call " + std::to_string(n) + ", round " + std::to_string(round));
    auto record = store::Record::Open(folder, NextStamp());
    ASSERT_THAT(record, IsOk());
    const auto before = record->Check();
    ASSERT_TRUE(before->Passed()) << before->findings.front().where << " " << before->findings.front().what;
    ASSERT_THAT(store::Repair(*record, {}, NextStamp()), IsOk());
    const auto after = record->Check();
    ASSERT_TRUE(after->findings.empty()) << after->findings.front().where << " " << after->findings.front().what;
    EXPECT_THAT(record->objects().Get(first_.sha256), IsOk());
    if (said.done && what == 0) {
      ASSERT_THAT(record->CaptureById(capture.id), IsOk());
      EXPECT_THAT(record->objects().Get(store::HashOf(Bytes(photo))), IsOk());
    }
    if (said.done && what == 1) {
      EXPECT_THAT(record->SubjectById(subject.id), IsOk());
    }
    if (said.done && what == 2) {
      EXPECT_THAT(record->SessionById(session.id), IsOk());
    }
    if (said.done && what == 3) {
      EXPECT_THAT(record->OutcomeById(report), IsOk());
    }
    if (what == 5) {
      EXPECT_TRUE(said.done || fs::exists(backup / store::kUnfinishedName) || !fs::exists(backup / "study.db") ||
                  fs::exists(backup / store::kManifestName))
          << "an interrupted backup is recognised";
    }
    const auto people = store::ReadIdentities(Identity(), kPassphrase);
    ASSERT_THAT(people, IsOk());
    EXPECT_EQ(people->size(), 1U) << "the identity file is the old or the new one";
  }
  [[nodiscard]] int killed() const { return killed_; }
  static constexpr int kKinds = 8;

 private:
  [[nodiscard]] fs::path Identity() const { return study_.folder() / store::kIdentityName; }
  static store::Identity Person(const std::string& name) { return {SubjectId{}, "S001", name, {}, "", {}, "tester"}; }

  SmallStudy study_;
  Subject subject_;
  Session session_;
  Capture first_;
  int killed_ = 0;
};

void Rounds(int count, std::uint32_t seed) {
  Killed study;
  std::mt19937 random(seed);
  for (int round = 0; round < count && !::testing::Test::HasFatalFailure(); ++round) {
    const int what = round % Killed::kKinds;
    // Most changes make 5 to 30 such calls, a backup or a merge up to about a hundred.
    const long most = what == 4 || what == 5 ? 80 : 20;
    study.Round(what, static_cast<long>(random() % static_cast<unsigned long>(most)), round);
  }
  EXPECT_GT(study.killed(), count / 2) << "most rounds must really be cut short";
}

TEST(Killed, AtAnyStepLosesNothingAcknowledged) { Rounds(24, 20261122); }
TEST(KilledLong, TwoHundredTimesLosesNothingAcknowledged) { Rounds(200, 7); }

}  // namespace
}  // namespace striae::testing
