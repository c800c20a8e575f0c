// A disk that is full, and one that became read-only: a clear message, and nothing is lost. Real file systems, which
// only root can make; skipped otherwise.
#include <sys/mount.h>
#include <unistd.h>

#include "store/backup.h"
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
  EXPECT_THAT(added, FailsWith(ErrorCode::kIo, "check the folder's permissions and the disk"));
  const fs::path copy = study_.dir() / "copy";
  EXPECT_THAT(store::Restore(disk_ / "study", copy, {}, NextStamp()), IsOk()) << "a backup on a read-only medium";
  MakeReadOnly(false);
  EXPECT_TRUE(Open().Check()->findings.empty());
}

}  // namespace
}  // namespace striae::testing
