// Content-addressed files: whole or absent, never overwritten, never silently altered.
#include <csignal>
#include <fstream>

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/store/small_study.h"

namespace striae::testing {
namespace {

namespace fs = std::filesystem;
using store::ObjectStore;

void Overwrite(const fs::path& file, const std::string& content) {
  fs::permissions(file, fs::perms::owner_write, fs::perm_options::add);
  std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
}

TEST(Objects, AreNamedByTheirSha256) {
  const TempDir dir;
  const auto objects = ObjectStore::Open(dir / "objects");
  // FIPS 180-4's example: the digest of "abc".
  const auto sha256 = objects->Put(Bytes("abc"));
  ASSERT_THAT(sha256, IsOk());
  EXPECT_EQ(sha256->ToString(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const fs::path file = dir / "objects/ba/7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
  EXPECT_EQ(objects->PathOf(*sha256), file);
  struct stat status {};
  ASSERT_EQ(::stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0444U) << "read-only for everyone";
  EXPECT_EQ(*objects->Get(*sha256), std::vector<std::uint8_t>({'a', 'b', 'c'}));
}

TEST(Objects, PutTwiceAreOneFileAndLeaveNothingElse) {
  const TempDir dir;
  const auto objects = ObjectStore::Open(dir / "objects");
  const auto first = objects->Put(Bytes("abc"));
  const auto written = fs::last_write_time(objects->PathOf(*first));
  EXPECT_EQ(*objects->Put(Bytes("abc")), *first);
  EXPECT_EQ(fs::last_write_time(objects->PathOf(*first)), written);
  const auto listing = objects->List();
  EXPECT_EQ(listing->objects.size(), 1U);
  EXPECT_TRUE(listing->strangers.empty());
}

TEST(Objects, AreNamedWhenCutOrAltered) {
  const TempDir dir;
  const auto objects = ObjectStore::Open(dir / "objects");
  const Sha256 cut = *objects->Put(Bytes("a photograph"));
  const Sha256 altered = *objects->Put(Bytes("another photograph"));
  Overwrite(objects->PathOf(cut), "a photo");
  Overwrite(objects->PathOf(altered), "anotheR photograph");
  for (const Sha256& sha256 : {cut, altered}) {
    EXPECT_THAT(objects->Get(sha256), FailsWith(ErrorCode::kRecordDamaged, sha256.ToString()));
    EXPECT_THAT(objects->Verify(sha256), FailsWith(ErrorCode::kRecordDamaged, "altered or cut"));
  }
  EXPECT_THAT(objects->Put(Bytes("a photograph")), FailsWith(ErrorCode::kRecordDamaged, cut.ToString()))
      << "the altered file is evidence: it is not overwritten";
  EXPECT_THAT(objects->Get(store::HashOf(Bytes("never seen"))), FailsWith(ErrorCode::kNotFound, "missing"));
}

TEST(Objects, SurviveAKillThatLeftHalfAFile) {
  const TempDir dir;
  const auto objects = ObjectStore::Open(dir / "objects");
  std::ofstream(dir / "objects/.part-Ab12Cd") << "half a photogr";
  fs::create_directory(dir / "objects/ba");
  std::ofstream(dir / "objects/ba/not-a-hash") << "x";
  const Sha256 sha256 = *objects->Put(Bytes("a photograph"));
  EXPECT_THAT(objects->Get(sha256), IsOk());
  const auto listing = objects->List();
  EXPECT_EQ(listing->objects, std::vector<Sha256>({sha256}));
  ASSERT_EQ(listing->strangers.size(), 2U);
  EXPECT_EQ(listing->strangers[0].filename(), ".part-Ab12Cd");
}

TEST(Objects, OnAReadOnlyFolderSayWhatToCheck) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TempDir dir;
  const auto objects = ObjectStore::Open(dir / "objects");
  fs::permissions(dir / "objects", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THAT(objects->Put(Bytes("abc")), FailsWith(ErrorCode::kIo, "permissions"));
}

TEST(Objects, SayWhereSomethingIsInTheWay) {
  const TempDir dir;
  const auto objects = ObjectStore::Open(dir / "objects");
  std::ofstream(dir / "objects/ba") << "a file where the folder of \"abc\" should be";
  EXPECT_THAT(objects->Put(Bytes("abc")), FailsWith(ErrorCode::kIo, "objects/ba"));
}

TEST(Objects, OnAFullDiskAreAbsentAndSaySo) {
  // A size limit on this process' files stands in for the full disk: write() fails the same way in mid-file.
  const TempDir dir;
  const auto objects = ObjectStore::Open(dir / "objects");
  const std::string large(1 << 20, 'x');
  const auto put_on_full_disk = [&] {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4096, 4096};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const auto put = objects->Put(Bytes(large));
    ::_exit(!put && put.error().code == ErrorCode::kIo ? 0 : 1);
  };
  EXPECT_EXIT(put_on_full_disk(), ::testing::ExitedWithCode(0), "");
  const auto listing = objects->List();
  EXPECT_TRUE(listing->objects.empty());
  EXPECT_TRUE(listing->strangers.empty()) << listing->strangers.front();
}

}  // namespace
}  // namespace striae::testing
