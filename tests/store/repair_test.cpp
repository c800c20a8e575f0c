// `check --repair` settles what a kill has left and destroys nothing.
#include "store/repair.h"

#include <fstream>

#include "tests/store/findings.h"
#include "tests/support/files.h"

namespace striae::testing {
namespace {

namespace fs = std::filesystem;
using store::Repair;

std::vector<std::uint8_t> BytesOf(const std::string& text) { return {text.begin(), text.end()}; }

class RepairTest : public ::testing::Test {
 protected:
  RepairTest() {
    session_ = study_.Open(study_.EnrolWithConsent("S001"));
    capture_ = study_.Import(session_, "a photograph");
  }
  std::vector<store::Repaired> Now(const store::RepairOptions& options = {}) {
    auto repaired = Repair(study_.record(), options, NextStamp());
    EXPECT_THAT(repaired, IsOk());
    return repaired ? *repaired : std::vector<store::Repaired>{};
  }
  /// The content of every file in quarantine but the notes.
  std::vector<std::string> Quarantined() {
    std::vector<std::string> all;
    std::error_code absent;
    for (const auto& entry : fs::directory_iterator(study_.folder() / "quarantine", absent)) {
      if (entry.path().string().ends_with(".why.json")) continue;
      EXPECT_TRUE(fs::exists(entry.path().string() + ".why.json"));
      all.push_back(ReadText(entry.path()));
    }
    std::sort(all.begin(), all.end());
    return all;
  }
  void Damage(const std::string& content) {
    const fs::path object = study_->objects().PathOf(capture_.sha256);
    fs::permissions(object, fs::perms::owner_write, fs::perm_options::add);
    WriteBytes(object, BytesOf(content));
  }

  SmallStudy study_;
  Session session_;
  Capture capture_;
};

TEST_F(RepairTest, ASoundStudyIsLeftAsItIs) {
  const auto head = study_->Head();
  EXPECT_TRUE(Now().empty());
  EXPECT_EQ(study_->Head()->sequence, head->sequence);
}

TEST_F(RepairTest, WhatAKillLeavesIsKeptInQuarantineAndNoted) {
  WriteBytes(study_.folder() / "objects/.part-Zz9Yy8", BytesOf("half a photo"));
  WriteBytes(study_.folder() / "objects/12/.part-abcdef", BytesOf("another half"));
  WriteBytes(study_.folder() / "objects/.part-nothin", {});
  WriteBytes(study_.folder() / ".study.db.new-wal", BytesOf("of an init"));
  ASSERT_THAT(study_->objects().Put(Bytes("killed before its row")), IsOk());
  EXPECT_EQ(study_->Check()->findings.size(), 5U);
  EXPECT_EQ(Now().size(), 5U);
  EXPECT_TRUE(study_->Check()->findings.empty()) << study_->Check()->findings.front().where;
  EXPECT_EQ(Quarantined(), (std::vector<std::string>{"another half", "half a photo", "killed before its row"}));
  const auto history = study_->History("S001");
  ASSERT_THAT(history, IsOk());
  EXPECT_EQ(RawSql(study_.database(), "SELECT 1 / (count(*) = 5) FROM audit WHERE entity = 'repair'"), "");
  study_.Import(session_, "killed before its row");
  EXPECT_TRUE(study_->Check()->Passed());
}

TEST_F(RepairTest, TwiceIsOnce) {
  ASSERT_THAT(study_->objects().Put(Bytes("killed before its row")), IsOk());
  EXPECT_EQ(Now().size(), 1U);
  EXPECT_TRUE(Now().empty());
  // The same orphan again: both copies stay.
  ASSERT_THAT(study_->objects().Put(Bytes("killed before its row")), IsOk());
  EXPECT_EQ(Now().size(), 1U);
  EXPECT_EQ(Quarantined().size(), 2U);
}

TEST_F(RepairTest, ALostPhotographComesBackFromAnUnfinishedCopy) {
  fs::remove(study_->objects().PathOf(capture_.sha256));
  WriteBytes(study_.folder() / "objects/.part-Zz9Yy8", BytesOf("a photograph"));
  Now();
  EXPECT_TRUE(study_->Check()->findings.empty());
  EXPECT_EQ(*study_->objects().Get(capture_.sha256), BytesOf("a photograph"));
}

TEST_F(RepairTest, ADamagedPhotographComesBackFromAnotherCopyAndTheDamagedOneIsKept) {
  SmallStudy other("other");
  ASSERT_THAT(other->objects().Put(Bytes("a photograph")), IsOk());
  Damage("a phot");
  EXPECT_TRUE(Now().empty()) << "without another copy there is nothing to do";
  EXPECT_FALSE(study_->Check()->Passed());
  store::RepairOptions options;
  options.from = other.folder();
  Now(options);
  EXPECT_TRUE(study_->Check()->findings.empty());
  EXPECT_EQ(Quarantined(), std::vector<std::string>{"a phot"});
}

TEST_F(RepairTest, IsRefusedWhileAnotherProgramHasTheStudyOpen) {
  const auto other = store::Record::Open(study_.folder(), NextStamp());
  ASSERT_THAT(other, IsOk());
  ASSERT_THAT(study_->objects().Put(Bytes("being imported just now")), IsOk());
  EXPECT_THAT(Repair(study_.record(), {}, NextStamp()), FailsWith(ErrorCode::kIo, "has this study open"));
  EXPECT_TRUE(study_->objects().Has(store::HashOf(Bytes("being imported just now"))));
}

}  // namespace
}  // namespace striae::testing
