// Names stand in one encrypted file; whatever is wrong with it, it is told and the file stays as it is.
#include "store/identity.h"

#include <filesystem>

#include <sys/wait.h>
#include <unistd.h>

#include "store/check.h"
#include "tests/store/findings.h"
#include "tests/support/files.h"

namespace striae::testing {
namespace {

namespace fs = std::filesystem;
using store::Identity;

constexpr store::IdentityCost kQuick{1, 8192};  // the least that libsodium allows: tests do not guess passphrases
const std::string kPassphrase = "four random words here";

store::IdentityRandom Random(std::uint8_t first) {
  store::IdentityRandom random;
  for (std::size_t i = 0; i < random.size(); ++i) random[i] = static_cast<std::uint8_t>(first + i);
  return random;
}

Identity Person(const std::string& pseudonym, const std::string& name) {
  return {CountedId<SubjectId>(), pseudonym, name, Date{1950, 1, 31}, "H-123456", {1'777'880'000'000}, "coordinator"};
}

class IdentityFile : public ::testing::Test {
 protected:
  IdentityFile() {
    people_ = {Person("S001", "Test^Subject"), Person("S002", "Probe^Zweite")};
    EXPECT_THAT(store::WriteIdentities(file_, people_, kPassphrase, Random(1), kQuick), IsOk());
  }
  TempDir dir_;
  fs::path file_ = dir_ / "identity.striae";
  std::vector<Identity> people_;
};

TEST_F(IdentityFile, ComesBackWithItsPassphrase) {
  const auto read = store::ReadIdentities(file_, kPassphrase);
  ASSERT_THAT(read, IsOk());
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ(read->at(1).name, "Probe^Zweite");
  EXPECT_EQ(read->at(0).subject, people_[0].subject);
  EXPECT_EQ(read->at(0).birth_date, (Date{1950, 1, 31}));
  EXPECT_EQ(read->at(0).hospital_id, "H-123456");
  EXPECT_THAT(store::CheckIdentityFile(file_), IsOk());
  EXPECT_EQ(fs::status(file_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(IdentityFile, ShowsNoneOfItsWordsAndNothingOfSqlite) {
  const std::string text = ReadText(file_);
  for (const char* word : {"Subject", "Zweite", "H-123456", "S001", "1950", "SQLite format", "person"}) {
    EXPECT_EQ(text.find(word), std::string::npos) << word;
  }
}

TEST_F(IdentityFile, IsAnotherFileWithOtherRandomBytes) {
  const auto before = ReadBytes(file_);
  ASSERT_THAT(store::WriteIdentities(file_, people_, kPassphrase, Random(99), kQuick), IsOk());
  const auto after = ReadBytes(file_);
  EXPECT_EQ(before.size(), after.size());
  std::size_t equal = 0;
  for (std::size_t i = 100; i < before.size(); ++i) equal += before[i] == after[i] ? 1 : 0;
  EXPECT_LT(equal, before.size() / 50) << "by chance one byte of 256";
}

TEST_F(IdentityFile, WithAWrongPassphraseSaysSo) {
  const auto before = ReadBytes(file_);
  EXPECT_THAT(store::ReadIdentities(file_, "four random words hers"),
              FailsWith(ErrorCode::kRecordRefused, "passphrase does not open"));
  EXPECT_EQ(ReadBytes(file_), before);
}

TEST_F(IdentityFile, CutAnywhereIsDamagedNeverAWrongPassphrase) {
  const auto whole = ReadBytes(file_);
  for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 40) {
    WriteBytes(file_, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    const auto read = store::ReadIdentities(file_, kPassphrase);
    ASSERT_FALSE(read) << size;
    EXPECT_EQ(read.error().code, ErrorCode::kRecordDamaged) << size;
    EXPECT_FALSE(store::CheckIdentityFile(file_));
  }
}

TEST_F(IdentityFile, AFlippedByteIsDamagedNeverAWrongPassphrase) {
  const auto whole = ReadBytes(file_);
  for (std::size_t at = 0; at < whole.size(); at += at < 110 ? 1 : 997) {
    auto changed = whole;
    changed[at] ^= 0x40;
    WriteBytes(file_, changed);
    const auto read = store::ReadIdentities(file_, kPassphrase);
    ASSERT_FALSE(read) << at;
    const bool version = at == 8;  // a greater number there is a newer format
    EXPECT_EQ(read.error().code, version ? ErrorCode::kRecordRefused : ErrorCode::kRecordDamaged) << at;
  }
}

TEST_F(IdentityFile, AForgerWhoKnowsTheFormatButNotThePassphraseChangesNothing) {
  auto forged = ReadBytes(file_);
  forged[forged.size() - 40] ^= 1;  // within the last chunk; the checksum behind it is made anew
  const std::span<const std::uint8_t> covered(forged.data(), forged.size() - 32);
  const Sha256 checksum = store::HashOf(covered);
  std::copy(checksum.bytes.begin(), checksum.bytes.end(), forged.end() - 32);
  WriteBytes(file_, forged);
  EXPECT_THAT(store::ReadIdentities(file_, kPassphrase), FailsWith(ErrorCode::kRecordDamaged, "forged"));
}

TEST_F(IdentityFile, RefusesAShortPassphraseAndStaysAsItIs) {
  const auto before = ReadBytes(file_);
  EXPECT_THAT(store::WriteIdentities(file_, people_, "short", Random(3), kQuick),
              FailsWith(ErrorCode::kUsage, "too short"));
  EXPECT_EQ(ReadBytes(file_), before);
  EXPECT_THAT(store::WriteIdentities(dir_ / "absent/identity.striae", people_, kPassphrase, Random(3), kQuick),
              FailsWith(ErrorCode::kIo, "cannot write"));
}

TEST_F(IdentityFile, HoldsManyPeople) {
  std::vector<Identity> many;
  for (int i = 0; i < 2000; ++i) many.push_back(Person("P" + std::to_string(10000 + i), "Name" + std::to_string(i)));
  ASSERT_THAT(store::WriteIdentities(file_, many, kPassphrase, Random(5), kQuick), IsOk());
  EXPECT_GT(fs::file_size(file_), 3U * 65536) << "several chunks";
  const auto read = store::ReadIdentities(file_, kPassphrase);
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->size(), 2000U);
  EXPECT_EQ(read->back().name, "Name1999");
}

/// A study whose identities are changed as the command does it.
class StudyIdentities : public ::testing::Test {
 protected:
  Status Put(store::Record& record, const std::string& pseudonym, const std::string& name) const {
    const auto edit = [&](std::vector<Identity>& all) -> Status {
      std::erase_if(all, [&](const Identity& known) { return known.pseudonym == pseudonym; });
      all.push_back(Person(pseudonym, name));
      return {};
    };
    return store::ChangeIdentities(record, {kPassphrase, {}, edit, Random(7), kQuick}, NextStamp());
  }
  [[nodiscard]] fs::path file() const { return study_.folder() / store::kIdentityName; }
  SmallStudy study_;
};

TEST_F(StudyIdentities, ChangedLeaveARowWithoutAnyContent) {
  const auto before = study_->Head()->sequence;
  ASSERT_THAT(Put(study_.record(), "S001", "Test^Subject"), IsOk());
  EXPECT_EQ(study_->Head()->sequence, before + 1);
  EXPECT_EQ(RawSql(study_.database(),
                   "SELECT 1 / count(*) FROM audit WHERE action = 'note' AND entity = 'identity.striae' AND field = "
                   "'set' AND user = 'coordinator'"),
            "");
  EXPECT_EQ(RawSql(study_.database(), "SELECT 1 / (count(*) = 0) FROM audit WHERE new_value LIKE '%Subject%'"), "");
  const store::IdentityChange passphrase{kPassphrase, "another four words",
                                         [](std::vector<Identity>&) { return Status(); }, Random(8), kQuick};
  ASSERT_THAT(store::ChangeIdentities(study_.record(), passphrase, NextStamp()), IsOk());
  EXPECT_EQ(RawSql(study_.database(),
                   "SELECT 1 / count(*) FROM audit WHERE entity = 'identity.striae' AND field = 'passphrase'"),
            "");
  EXPECT_EQ(store::ReadIdentities(file(), "another four words")->size(), 1U);
  EXPECT_TRUE(study_->Check()->findings.empty());
}

TEST_F(StudyIdentities, ThatTheTrailDoesNotKnowAreNamedByTheCheck) {
  ASSERT_THAT(Put(study_.record(), "S001", "Test^Subject"), IsOk());
  const auto first = ReadBytes(file());
  ASSERT_THAT(Put(study_.record(), "S001", "Test^Other"), IsOk());
  EXPECT_TRUE(study_->Check()->findings.empty());
  WriteBytes(file(), first);
  EXPECT_TRUE(study_->Check()->findings.empty()) << "a kill between row and file leaves the one before";
  fs::remove(file());
  ASSERT_THAT(store::WriteIdentities(file(), {Person("S001", "Test^Third")}, kPassphrase, Random(3), kQuick), IsOk());
  const auto check = study_->Check();
  ASSERT_EQ(check->findings.size(), 1U);
  EXPECT_EQ(check->findings.front().where, store::kIdentityName);
  EXPECT_NE(check->findings.front().what.find("none that the trail knows"), std::string::npos);
}

TEST_F(StudyIdentities, ThatAreRefusedLeaveNeitherARowNorAChange) {
  ASSERT_THAT(Put(study_.record(), "S001", "Test^Subject"), IsOk());
  const auto before = ReadBytes(file());
  const auto head = study_->Head()->sequence;
  const store::IdentityChange wrong{
      "not the passphrase", {}, [](std::vector<Identity>&) { return Status(); }, Random(9), kQuick};
  EXPECT_THAT(store::ChangeIdentities(study_.record(), wrong, NextStamp()),
              FailsWith(ErrorCode::kRecordRefused, "passphrase does not open"));
  const store::IdentityChange refused{kPassphrase,
                                      {},
                                      [](std::vector<Identity>&) -> Status { return Fail(ErrorCode::kUsage, "no"); },
                                      Random(9),
                                      kQuick};
  EXPECT_THAT(store::ChangeIdentities(study_.record(), refused, NextStamp()), FailsWith(ErrorCode::kUsage, "no"));
  EXPECT_EQ(ReadBytes(file()), before);
  EXPECT_EQ(study_->Head()->sequence, head);
}

TEST_F(StudyIdentities, SetByFourProgramsAtOnceAreAllThere) {
  study_.Close();
  constexpr int kPrograms = 4, kEach = 8;
  std::vector<pid_t> children;
  for (int program = 0; program < kPrograms; ++program) {
    const pid_t child = ::fork();
    if (child == 0) {
      for (int used = 0; used < program * kEach; ++used) CountedUuid();  // every program names other people
      auto record = store::Record::Open(study_.folder(), NextStamp());
      bool good = record.has_value();
      for (int i = 0; good && i < kEach; ++i) {
        good = Put(*record, "P" + std::to_string(program * 100 + i), "Name").has_value();
      }
      ::_exit(good ? 0 : 1);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(store::ReadIdentities(file(), kPassphrase)->size(), static_cast<std::size_t>(kPrograms * kEach));
}

}  // namespace
}  // namespace striae::testing
