// Damaged bytes through everything of the record that reads files: an error or a finding that says so, never a crash,
// an exception or memory without bound. The corpus is made here, the damage from a fixed seed.
#include <filesystem>
#include <random>

#include "store/backup.h"
#include "store/check.h"
#include "store/identity.h"
#include "tests/store/findings.h"
#include "tests/support/files.h"

namespace striae::testing {
namespace {

namespace fs = std::filesystem;
using Content = std::vector<std::uint8_t>;

/// One to eight bytes changed, sometimes the end cut off.
Content Damage(const Content& whole, std::mt19937& random) {
  Content changed = whole;
  const int edits = 1 + static_cast<int>(random() % 8);
  for (int edit = 0; edit < edits; ++edit) changed[random() % changed.size()] = static_cast<std::uint8_t>(random());
  if (random() % 5 == 0) changed.resize(random() % changed.size());
  return changed;
}

template <typename Outcome>
void ExpectSaid(const Outcome& outcome) {
  if (outcome) return;
  EXPECT_NE(outcome.error().code, ErrorCode::kInternal) << outcome.error().Describe();
  EXPECT_FALSE(outcome.error().message.empty());
}

TEST(FuzzRecord, AStudyWithAnyBytesOfItsDatabaseWrong) {
  SmallStudy study;
  const Session session = study.Open(study.EnrolWithConsent("S001"));
  const Capture capture = study.Import(session, "a photograph");
  ASSERT_THAT(study->AddReport(CountedId<ReportId>(), capture.id, WoundReport(capture, 2.5), NextStamp()), IsOk());
  // A new study is mostly empty pages, one for each table and index: it needs content that can be damaged.
  for (int i = 0; i < 150; ++i) study.Enrol("T" + std::to_string(1000 + i));
  study.Close();
  ASSERT_EQ(RawSql(study.database(), "PRAGMA wal_checkpoint(TRUNCATE)"), "");
  const Content whole = ReadBytes(study.database());
  std::mt19937 random(20261122);
  int opened = 0, passed = 0;
  constexpr int kRounds = 120;
  for (int round = 0; round < kRounds; ++round) {
    SCOPED_TRACE(round);
    for (const char* log : {"study.db-wal", "study.db-shm"}) fs::remove(study.folder() / log);
    WriteBytes(study.database(), Damage(whole, random));
    auto record = store::Record::Open(study.folder(), NextStamp());
    ExpectSaid(record);
    if (!record) continue;
    ++opened;
    ExpectSaid(record->Results());
    ExpectSaid(record->Sessions());
    ExpectSaid(record->Work());
    ExpectSaid(record->GetOverview());
    ExpectSaid(record->Describe("S001"));
    ExpectSaid(record->History("S001"));
    const auto check = store::Check(*record, {});
    ExpectSaid(check);
    passed += check && check->Passed() ? 1 : 0;
  }
  EXPECT_GT(opened, kRounds / 4) << "the damage must get past the first page";
  EXPECT_LT(passed, kRounds / 2) << "what passes has its damage in bytes that nothing uses";
}

TEST(FuzzRecord, AnIdentityFileOfAnyBytes) {
  const TempDir dir;
  const fs::path file = dir / store::kIdentityName;
  const std::string passphrase = "four random words here";
  const store::Identity person{CountedId<SubjectId>(), "S001", "Test^Subject", {}, "", {}, "tester"};
  ASSERT_THAT(store::WriteIdentities(file, {person}, passphrase, {}, {1, 8192}), IsOk());
  const Content whole = ReadBytes(file);
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    Content changed = Damage(whole, random);
    if (round % 2 == 0 && changed.size() > 32) {  // with its checksum made anew, so that what is behind it is reached
      const std::span<const std::uint8_t> covered(changed.data(), changed.size() - 32);
      const Sha256 checksum = store::HashOf(covered);
      std::copy(checksum.bytes.begin(), checksum.bytes.end(), changed.end() - 32);
    }
    WriteBytes(file, changed);
    const auto read = store::ReadIdentities(file, passphrase);
    if (read) {
      EXPECT_EQ(changed, whole);
    } else {
      EXPECT_TRUE(read.error().code == ErrorCode::kRecordDamaged || read.error().code == ErrorCode::kRecordRefused ||
                  read.error().code == ErrorCode::kIo)
          << read.error().Describe();
    }
  }
}

TEST(FuzzRecord, ABackupWhoseManifestIsAnything) {
  SmallStudy study;
  ASSERT_THAT(store::Backup(study.record(), study.dir() / "backup", {}, NextStamp()), IsOk());
  const fs::path manifest = study.dir() / "backup" / store::kManifestName;
  const Content whole = ReadBytes(manifest);
  fs::permissions(manifest, fs::perms::owner_write, fs::perm_options::add);
  std::mt19937 random(11);
  for (int round = 0; round < 25; ++round) {
    WriteBytes(manifest, Damage(whole, random));
    const fs::path to = study.dir() / ("again" + std::to_string(round));
    ExpectSaid(store::Restore(study.dir() / "backup", to, {}, NextStamp()));
  }
}

TEST(FuzzRecord, HeadsOfAnyText) {
  const std::string good = "12:" + std::string(64, 'a') + " 3f0c2f6e-8f4f-4c1e-9d39-5d2f3f1f9a11";
  ASSERT_THAT(store::ParseHead(good), IsOk());
  std::mt19937 random(13);
  for (int round = 0; round < 3000; ++round) {
    std::string text = good;
    for (int edit = 0; edit < 1 + round % 4; ++edit) text[random() % text.size()] = static_cast<char>(random());
    if (round % 3 == 0) text.resize(random() % text.size());
    const auto head = store::ParseHead(text);
    if (!head) {
      EXPECT_EQ(head.error().code, ErrorCode::kUsage);
    } else {
      EXPECT_THAT(store::ParseHead(ToText(*head)), IsOk());
    }
  }
}

}  // namespace
}  // namespace striae::testing
