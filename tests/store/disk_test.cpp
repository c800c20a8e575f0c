// A disk that is full, and one that became read-only: a clear message, and nothing is lost. Real file systems, which
// only root can make (skipped otherwise), and a limit of the system's and another user, which everybody can have.
#include <csignal>
#include <fstream>

#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "store/backup.h"
#include "store/identity.h"
#include "store/repair.h"
#include "tests/store/findings.h"
#include "tests/support/files.h"

namespace striae::testing {
namespace {

namespace fs = std::filesystem;

/// A small file system of its own.
class SmallDisk : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(disk_);
    mounted_ = ::mount("tmpfs", disk_.c_str(), "tmpfs", 0, "size=2m") == 0;
    if (!mounted_) GTEST_SKIP() << "only root can make a small file system for this test";
    session_ = study_.Open(study_.EnrolWithConsent("S001"));
    study_.Close();
    ASSERT_THAT(store::Restore(study_.folder(), disk_ / "study", {}, NextStamp()), IsOk());
  }
  void TearDown() override {
    if (mounted_) ::umount2(disk_.c_str(), MNT_DETACH);
  }
  void MakeReadOnly(bool read_only) {
    ASSERT_EQ(::mount("tmpfs", disk_.c_str(), "tmpfs",
                      MS_REMOUNT | (read_only ? static_cast<unsigned long>(MS_RDONLY) : 0UL), "size=2m"),
              0);
  }
  [[nodiscard]] store::Record Open() const { return *store::Record::Open(disk_ / "study", NextStamp()); }

  SmallStudy study_;
  fs::path disk_ = study_.dir() / "disk";
  Session session_;
  bool mounted_ = false;
};

TEST_F(SmallDisk, WhenFullRefusesAndLosesNothing) {
  auto record = Open();
  std::vector<Capture> acknowledged;
  Result<store::Record::Added> last = Fail(ErrorCode::kInternal, "");
  for (int i = 0; i < 100; ++i) {
    const std::string photo = std::to_string(i) + std::string(60'000, 'x');
    last = record.AddCapture(SmallStudy::Photograph(session_), Bytes(photo), NextStamp());
    if (!last) break;
    acknowledged.push_back(last->capture);
  }
  ASSERT_FALSE(last) << "six megabytes do not fit";
  EXPECT_EQ(last.error().code, ErrorCode::kIo);
  EXPECT_GT(acknowledged.size(), 3U);
  for (const Capture& capture : acknowledged) EXPECT_THAT(record.objects().Get(capture.sha256), IsOk());
  EXPECT_EQ(record.Captures(session_.id)->size(), acknowledged.size());
  const auto check = record.Check();
  EXPECT_TRUE(check->Passed()) << check->findings.front().where << " " << check->findings.front().what;
}

TEST_F(SmallDisk, WithNoByteLeftIsNamedWhenTheStudyIsOpened) {
  {
    std::ofstream filler(disk_ / "filler");
    while (filler.write(std::string(4096, 'x').data(), 4096).flush()) {
    }
  }
  EXPECT_THAT(store::Record::Open(disk_ / "study", NextStamp()),
              FailsWith(ErrorCode::kIo, "no room is left on the disk"));
  fs::remove(disk_ / "filler");
  EXPECT_TRUE(Open().Check()->findings.empty());
}

TEST_F(SmallDisk, WhenFullABackupToItIsRecognisedAsUnfinished) {
  auto record = Open();
  WriteBytes(disk_ / "filler", std::vector<std::uint8_t>(1'300'000));
  EXPECT_FALSE(store::Backup(record, disk_ / "backup", {}, NextStamp()));
  EXPECT_FALSE(fs::exists(disk_ / "backup/backup.json"));
  EXPECT_FALSE(fs::exists(disk_ / "backup") && !fs::exists(disk_ / "backup" / store::kUnfinishedName) &&
               fs::exists(disk_ / "backup/study.db"));
}

TEST_F(SmallDisk, WhenReadOnlyRefusesAndSaysWhatToCheck) {
  {
    auto record = Open();
    ASSERT_THAT(record.AddCapture(SmallStudy::Photograph(session_), Bytes("a photograph"), NextStamp()), IsOk());
  }
  MakeReadOnly(true);
  auto record = store::Record::Open(disk_ / "study", NextStamp());
  const auto added =
      record ? Status(record->AddSubject({CountedId<SubjectId>(), "S002", study_.site(), {}, {}}, NextStamp()))
             : Status(Fail(record.error()));
  EXPECT_THAT(added, FailsWith(ErrorCode::kIo, "cannot be written by this user (Read-only file system)"));
  const fs::path copy = study_.dir() / "copy";
  EXPECT_THAT(store::Restore(disk_ / "study", copy, {}, NextStamp()), IsOk()) << "a backup on a read-only medium";
  MakeReadOnly(false);
  EXPECT_TRUE(Open().Check()->findings.empty());
}

/// What a child of this program says; whatever it changes of itself ends with it.
template <typename Work>
std::string InAChild(Work work) {
  int ends[2];
  EXPECT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const std::string text = work();
    (void)!::write(ends[1], text.data(), text.size());
    ::_exit(0);
  }
  ::close(ends[1]);
  std::string text;
  for (char byte = 0; ::read(ends[0], &byte, 1) == 1;) text += byte;
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return text;
}

template <typename Outcome>
std::string SaidOf(const Outcome& outcome) {
  return outcome ? "done" : outcome.error().Describe();
}

/// No file may become larger than this for the calling program: a write fails as on a full disk, also without root.
void LimitFileSize(rlim_t bytes) {
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{bytes, bytes};
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

TEST(FullDisk, APhotographThatDoesNotFitIsRefusedAndLeavesNothing) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  const fs::path folder = study.folder();
  study.Close();
  const std::string said = InAChild([&] {
    LimitFileSize(1'500'000);
    auto record = store::Record::Open(folder, NextStamp());
    const std::string large(2'000'000, 'x');
    return record ? SaidOf(record->AddCapture(SmallStudy::Photograph(session), Bytes(large), NextStamp()))
                  : SaidOf(record);
  });
  EXPECT_THAT(said, ::testing::HasSubstr("free space"));
  study.Reopen();
  EXPECT_TRUE(study->Captures(session.id)->empty());
  EXPECT_TRUE(study->Check()->findings.empty()) << "no part of it is left";
}

TEST(FullDisk, StopsStudyDbBeforeAChangeAndNotWithinOne) {
  SmallStudy study;
  const fs::path folder = study.folder();
  study.Close();
  const auto size = fs::file_size(folder / "study.db");
  const std::string said = InAChild([&] {
    LimitFileSize(size + 200'000);  // the log reaches that first
    auto record = store::Record::Open(folder, NextStamp());
    for (int i = 0; i < 2000; ++i) {
      const Subject subject{CountedId<SubjectId>(), "S" + std::to_string(1000 + i), study.site(), {}, {}};
      if (const Status added = record->AddSubject(subject, NextStamp()); !added) return SaidOf(added);
    }
    return std::string("all of them");
  });
  EXPECT_THAT(said, ::testing::HasSubstr("disk"));
  study.Reopen();
  EXPECT_GT(study->Subjects()->size(), 10U) << "those before are there";
  EXPECT_TRUE(study->Check()->findings.empty());
}

TEST(FullDisk, LeavesTheIdentitiesAsTheyWere) {
  const TempDir dir;
  const fs::path file = dir / store::kIdentityName;
  const store::Identity person{CountedId<SubjectId>(), "S001", "Test^Subject", {}, "", {}, "tester"};
  const store::Identity other{CountedId<SubjectId>(), "S002", "Probe^Zweite", {}, "", {}, "tester"};
  const std::string passphrase = "four random words here";
  ASSERT_THAT(store::WriteIdentities(file, {person}, passphrase, {}, {1, 8192}), IsOk());
  const auto before = ReadBytes(file);
  const std::string said = InAChild([&] {
    LimitFileSize(4096);
    return SaidOf(store::WriteIdentities(file, {person, other}, passphrase, {}, {1, 8192}));
  });
  EXPECT_THAT(said, ::testing::HasSubstr("free space"));
  EXPECT_EQ(ReadBytes(file), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(dir.path()), fs::directory_iterator()), 1) << "no unfinished file";
}

/// Root may write everywhere; the child becomes a user to whom the study's folder is read-only.
TEST(ReadOnlyFolder, RefusesAChangeAndSaysWhatToCheck) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  const fs::path folder = study.folder();
  study.Close();
  constexpr auto kReadable = fs::perms::owner_read | fs::perms::owner_exec | fs::perms::group_read |
                             fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec;
  fs::permissions(folder.parent_path(), kReadable, fs::perm_options::add);
  fs::permissions(folder, kReadable);
  fs::permissions(folder / "objects", kReadable);
  constexpr uid_t kNobody = 65534;
  const auto as_nobody = [&](const auto& work) {
    return InAChild([&]() -> std::string {
      if (::getuid() == 0 && (::setgid(kNobody) != 0 || ::setuid(kNobody) != 0)) return "cannot become another user";
      auto record = store::Record::Open(folder, NextStamp());
      return record ? SaidOf(work(*record)) : SaidOf(record);
    });
  };
  const auto advice = ::testing::AllOf(::testing::HasSubstr("permissions"),
                                       ::testing::HasSubstr("cannot be written by this user (Permission denied)"));
  EXPECT_THAT(as_nobody([&](store::Record& record) {
                return record.AddCapture(SmallStudy::Photograph(session), Bytes("photo"), NextStamp());
              }),
              advice);
  EXPECT_THAT(as_nobody([&](store::Record& record) {
                return record.AddSubject({CountedId<SubjectId>(), "S002", study.site(), {}, {}}, NextStamp());
              }),
              advice);
  EXPECT_THAT(as_nobody([&](store::Record& record) {
                const auto same = [](std::vector<store::Identity>&) { return Status(); };
                return store::ChangeIdentities(record, {"four random words", {}, same, {}, {1, 8192}}, NextStamp());
              }),
              advice);
  fs::permissions(folder, fs::perms::owner_write, fs::perm_options::add);
  fs::permissions(folder / "objects", fs::perms::owner_write, fs::perm_options::add);
  study.Reopen();
  EXPECT_TRUE(study->Check()->findings.empty());
}

}  // namespace
}  // namespace striae::testing
