// A backup is the study: equal head, equal objects; an unfinished one cannot be mistaken for it.
#include "store/backup.h"

#include <fstream>
#include <thread>

#include "store/identity.h"
#include "tests/store/findings.h"
#include "tests/support/files.h"

namespace striae::testing {
namespace {

namespace fs = std::filesystem;

class BackupTest : public ::testing::Test {
 protected:
  BackupTest() {
    session_ = study_.Open(study_.EnrolWithConsent("S001"));
    capture_ = study_.Import(session_, "a photograph");
    destination_ = study_.dir() / "backup";
  }
  Result<store::BackupReport> Backup() { return store::Backup(study_.record(), destination_, {}, NextStamp()); }

  SmallStudy study_;
  Session session_;
  Capture capture_;
  fs::path destination_;
};

TEST_F(BackupTest, RestoresToEqualHashes) {
  const fs::path identity = study_.folder() / store::kIdentityName;
  ASSERT_THAT(store::WriteIdentities(identity, {}, "four random words", {}, {1, 8192}), IsOk());
  WriteBytes(study_.folder() / "quarantine/abc-DSC_0001.JPG", {4, 5});
  const auto head = *study_->Head();
  const auto report = Backup();
  ASSERT_THAT(report, IsOk());
  EXPECT_EQ(report->head.hash, head.hash);
  EXPECT_EQ(report->objects, 1);
  EXPECT_FALSE(fs::exists(destination_ / store::kUnfinishedName));
  const fs::path again = study_.dir() / "again";
  ASSERT_THAT(store::Restore(destination_, again, {}, NextStamp()), IsOk());
  auto record = store::Record::Open(again, NextStamp());
  ASSERT_THAT(record, IsOk());
  EXPECT_EQ(record->Head()->sequence, head.sequence);
  EXPECT_EQ(record->Head()->hash, head.hash);
  EXPECT_TRUE(record->Check(head)->findings.empty());
  EXPECT_THAT(record->objects().Get(capture_.sha256), IsOk());
  EXPECT_EQ(ReadBytes(again / store::kIdentityName), ReadBytes(identity));
  EXPECT_EQ(ReadBytes(again / "quarantine/abc-DSC_0001.JPG"), (std::vector<std::uint8_t>{4, 5}));
}

TEST_F(BackupTest, IsOneStateWhileAnotherProgramWrites) {
  std::atomic<bool> stop{false};
  std::thread writer([&] {
    auto record = store::Record::Open(study_.folder(), NextStamp());
    for (int i = 0; !stop; ++i) {
      const auto photo = "photo " + std::to_string(i);
      EXPECT_THAT(record->AddCapture(SmallStudy::Photograph(session_), Bytes(photo), NextStamp()), IsOk());
    }
  });
  const auto report = Backup();
  stop = true;
  writer.join();
  ASSERT_THAT(report, IsOk());
  EXPECT_TRUE(report->check.findings.empty());
  auto copy = store::Record::Open(destination_, NextStamp());
  EXPECT_EQ(copy->Captures(session_.id)->size(), static_cast<std::size_t>(report->objects));
  EXPECT_TRUE(study_->Check(report->head)->Passed()) << "the study has only grown since";
}

TEST_F(BackupTest, OverwritesNothing) {
  WriteBytes(destination_ / "letter.txt", {1});
  EXPECT_THAT(Backup(), FailsWith(ErrorCode::kRecordRefused, "not empty"));
  EXPECT_EQ(ReadBytes(destination_ / "letter.txt").size(), 1U);
  EXPECT_THAT(store::Restore(study_.folder(), destination_, {}, NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "not empty"));
}

TEST_F(BackupTest, AnUnfinishedOneIsRecognised) {
  // Stopped half-way, here by a photograph that is lost.
  fs::remove(study_->objects().PathOf(capture_.sha256));
  EXPECT_THAT(Backup(), FailsWith(ErrorCode::kRecordDamaged, "is missing"));
  EXPECT_TRUE(fs::exists(destination_ / store::kUnfinishedName));
  EXPECT_FALSE(fs::exists(destination_ / "study.db"));
  EXPECT_THAT(store::Restore(destination_, study_.dir() / "again", {}, NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "interrupted backup"));
  EXPECT_THAT(Backup(), FailsWith(ErrorCode::kRecordRefused, "interrupted copy"));
}

TEST_F(BackupTest, ADamagedPhotographIsNotCopiedAsIfItWereSound) {
  const fs::path object = study_->objects().PathOf(capture_.sha256);
  fs::permissions(object, fs::perms::owner_write, fs::perm_options::add);
  WriteBytes(object, {1, 2});
  EXPECT_THAT(Backup(), FailsWith(ErrorCode::kRecordDamaged, "altered or cut"));
}

TEST_F(BackupTest, OneThatWasChangedAfterwardsIsNotRestored) {
  ASSERT_THAT(Backup(), IsOk());
  {
    auto record = store::Record::Open(destination_, NextStamp());
    ASSERT_THAT(record->AddSubject({CountedId<SubjectId>(), "S002", study_.site(), {}, {}}, NextStamp()), IsOk());
  }
  EXPECT_THAT(store::Restore(destination_, study_.dir() / "again", {}, NextStamp()),
              FailsWith(ErrorCode::kRecordDamaged, "was changed since the backup"));
}

TEST_F(BackupTest, ABranchWritesItsOwnTrail) {
  store::RestoreOptions options;
  options.branch = CountedUuid();
  const fs::path laptop = study_.dir() / "laptop";
  ASSERT_THAT(store::Restore(study_.folder(), laptop, options, NextStamp()), IsOk());
  auto record = store::Record::Open(laptop, NextStamp());
  ASSERT_THAT(record->AddSubject({CountedId<SubjectId>(), "S002", study_.site(), {}, {}}, NextStamp()), IsOk());
  const auto report = record->Check();
  EXPECT_TRUE(report->findings.empty());
  EXPECT_EQ(report->heads.size(), 2U);
  EXPECT_EQ(report->head.sequence, 2) << "the note of the branch and the subject";
}

}  // namespace
}  // namespace striae::testing
