// Two copies of a study that were worked on apart: what comes together, what becomes a query, what is refused.
#include "tests/store/sites.h"
#include "tests/support/files.h"

namespace striae::testing {
namespace {

TEST(Merge, BringsWhatEachCopyAdded) {
  Sites sites;
  {
    auto a = sites.Open("a"), b = sites.Open("b");
    Enrol(a, "S002");
    Enrol(b, "S003");
    ASSERT_THAT(b.AddCapture(SmallStudy::Photograph(sites.session_), Bytes("taken at b"), NextStamp()), IsOk());
    ASSERT_THAT(a.AddCapture(SmallStudy::Photograph(sites.session_), Bytes("taken at a"), NextStamp()), IsOk());
  }
  EXPECT_EQ(sites.BothWays(), "");
  auto merged = sites.Open("a");
  EXPECT_EQ(merged.Subjects()->size(), 3U);
  const auto captures = merged.Captures(sites.session_.id);
  ASSERT_EQ(captures->size(), 3U);
  for (const Capture& capture : *captures) EXPECT_THAT(merged.objects().Get(capture.sha256), IsOk());
  EXPECT_TRUE(merged.Check()->findings.empty());
  EXPECT_EQ(merged.Check()->heads.size(), 2U) << "both chains are kept";
}

TEST(Merge, TwiceIsOnce) {
  Sites sites;
  {
    auto b = sites.Open("b");
    Enrol(b, "S003");
  }
  sites.Merge("a", "b");
  const auto content = ContentOf(sites.At("a"));
  const auto head = sites.Open("a").Head();
  const auto again = sites.Merge("a", "b");
  EXPECT_EQ(again.rows + again.audit_rows + again.objects, 0);
  EXPECT_EQ(ContentOf(sites.At("a")), content);
  EXPECT_EQ(sites.Open("a").Head()->sequence, head->sequence);
  sites.Merge("b", "a");
  EXPECT_EQ(Compare(sites.At("a"), sites.At("b")), "");
}

TEST(Merge, AFieldChangedAtBothTakesTheLaterValueAndAsks) {
  Sites sites;
  {
    auto a = sites.Open("a"), b = sites.Open("b");
    ASSERT_THAT(a.SetRole(sites.capture_.id, *CaptureRole::Parse("wound:W1"), "", NextStamp()), IsOk());
    ASSERT_THAT(b.SetRole(sites.capture_.id, *CaptureRole::Parse("wound:W2"), "", NextStamp()), IsOk());
  }
  EXPECT_EQ(sites.BothWays(), "");
  auto merged = sites.Open("a");
  EXPECT_EQ(merged.CaptureById(sites.capture_.id)->role.ToString(), "wound:W2");
  EXPECT_EQ(RawSql(sites.At("a") / "study.db", "SELECT 1 / (count(*) = 1) FROM data_query_now WHERE state = 'open'"),
            "");
  // Somebody decides; the decision stands above both and goes to the other copy without a new query.
  ASSERT_THAT(merged.SetRole(sites.capture_.id, *CaptureRole::Parse("wound:W1"), "it is W1", NextStamp()), IsOk());
  EXPECT_TRUE(sites.Merge("b", "a").queries.empty());
  EXPECT_EQ(sites.Open("b").CaptureById(sites.capture_.id)->role.ToString(), "wound:W1");
}

TEST(Merge, APseudonymGivenAtBothKeepsBothPeopleApart) {
  Sites sites;
  {
    auto a = sites.Open("a"), b = sites.Open("b");
    Enrol(a, "S002");
    Enrol(b, "S002");
  }
  EXPECT_EQ(sites.BothWays(), "");
  auto merged = sites.Open("a");
  EXPECT_EQ(merged.Subjects()->size(), 3U);
  EXPECT_THAT(merged.SubjectByPseudonym("S002"), IsOk());
  EXPECT_TRUE(merged.Check()->findings.empty());
}

TEST(Merge, APhotographImportedAtBothIsKeptTwiceAndAskedAbout) {
  Sites sites;
  {
    auto a = sites.Open("a"), b = sites.Open("b");
    ASSERT_THAT(a.AddCapture(SmallStudy::Photograph(sites.session_), Bytes("the card"), NextStamp()), IsOk());
    ASSERT_THAT(b.AddCapture(SmallStudy::Photograph(sites.session_), Bytes("the card"), NextStamp()), IsOk());
  }
  EXPECT_EQ(sites.BothWays(), "");
  auto merged = sites.Open("a");
  EXPECT_EQ(merged.CapturesOf(store::HashOf(Bytes("the card")))->size(), 2U);
}

TEST(Merge, APhotographProcessedAtBothHasOneOutcomeInForce) {
  Sites sites;
  {
    auto a = sites.Open("a"), b = sites.Open("b");
    for (const double volume : {3.6, 3.7}) {
      ASSERT_THAT(
          a.AddReport(CountedId<ReportId>(), sites.capture_.id, WoundReport(sites.capture_, volume), NextStamp()),
          IsOk());
    }
    ASSERT_THAT(b.AddReport(CountedId<ReportId>(), sites.capture_.id, WoundReport(sites.capture_, 3.8), NextStamp()),
                IsOk());
  }
  EXPECT_EQ(sites.BothWays(), "");
  auto merged = sites.Open("a");
  EXPECT_EQ(merged.Outcomes(sites.capture_.id)->size(), 4U);
  EXPECT_EQ(merged.Results()->size(), 2U) << "the two numbers of the last report";
}

TEST(Merge, ADeviceEnteredAtBothKeepsBothCalibrationsAndAsks) {
  Sites sites;
  for (const char* name : {"a", "b"}) {
    auto copy = sites.Open(name);
    ASSERT_THAT(copy.AddDevice({CountedId<DeviceId>(), "6123456", RigRange::kSmall, "NIKON D90", name}, NextStamp()),
                IsOk());
  }
  EXPECT_EQ(sites.BothWays(), "");
  auto merged = sites.Open("a");
  const auto devices = merged.Devices();
  ASSERT_EQ(devices->size(), 2U);
  EXPECT_EQ(merged.DeviceBySerial("6123456")->lens, "a") << "entered first, it keeps the serial of the photographs";
  EXPECT_EQ(devices->back().serial.substr(0, 8), "6123456.");
  EXPECT_EQ(RawSql(sites.At("a") / "study.db", "SELECT 1 / (count(*) = 1) FROM data_query_now WHERE state = 'open'"),
            "");
  EXPECT_TRUE(merged.Check()->findings.empty());
}

/// What lies in a folder, byte for byte; SQLite's shared memory is no content.
std::map<std::string, std::vector<std::uint8_t>> FilesOf(const fs::path& folder) {
  std::map<std::string, std::vector<std::uint8_t>> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (entry.is_regular_file() && !name.ends_with("-shm") && !name.ends_with("-wal")) files[name] = ReadBytes(entry);
  }
  return files;
}

TEST(Merge, TakesAnOlderCopyWithoutChangingIt) {
  Sites sites;
  {
    auto b = sites.Open("b");
    Enrol(b, "S003");
    ASSERT_THAT(b.AddCapture(SmallStudy::Photograph(sites.session_), Bytes("taken at b"), NextStamp()), IsOk());
  }
  ASSERT_EQ(store::detail::Migrations().size(), 9U)
      << "there is a newer format: take back all after 7 in the next line";
  ASSERT_EQ(RawSql(sites.At("b") / "study.db",
                   "DROP TRIGGER site_locked; DROP TRIGGER arm_locked; DROP TRIGGER device_locked; DROP TRIGGER "
                   "calibration_locked; DROP TRIGGER device_check_locked; DROP INDEX audit_by_entity; DROP INDEX "
                   "session_visit; DROP INDEX capture_role; PRAGMA "
                   "user_version=7; PRAGMA wal_checkpoint(TRUNCATE)"),
            "");
  const auto before = FilesOf(sites.At("b"));
  const TempDir scratch;
  {
    auto a = sites.Open("a");
    auto other = store::OpenOther(sites.At("b"), scratch.path(), NextStamp());
    ASSERT_THAT(other, IsOk());
    ASSERT_THAT(store::Merge(a, *other, {}, NextStamp()), IsOk());
    EXPECT_THAT(a.SubjectByPseudonym("S003"), IsOk());
    EXPECT_TRUE(a.Check()->Passed());
  }
  EXPECT_EQ(FilesOf(sites.At("b")), before);
}

TEST(Merge, RefusesAnotherStudyAndAFolderThatWasCopiedByHand) {
  Sites sites;
  SmallStudy stranger("stranger");
  auto a = sites.Open("a");
  EXPECT_THAT(store::Merge(a, stranger.record(), {}, NextStamp()), FailsWith(ErrorCode::kRecordRefused, "two studies"));
  sites.Copy(sites.At("a"), "by-hand", std::nullopt);
  auto by_hand = sites.Open("by-hand");
  Enrol(a, "S002");
  Enrol(by_hand, "S003");
  const auto before = a.Head();
  EXPECT_THAT(store::Merge(a, by_hand, {}, NextStamp()), FailsWith(ErrorCode::kRecordRefused, "copied by hand"));
  EXPECT_EQ(a.Head()->sequence, before->sequence);
  EXPECT_TRUE(a.Check()->findings.empty());
}

TEST(Merge, CarriesNoDamageOn) {
  Sites sites;
  ASSERT_EQ(RawSql(sites.At("b") / "study.db",
                   "DROP TRIGGER measurement_no_update; UPDATE measurement SET value = 1 WHERE number = 1"),
            "");
  auto a = sites.Open("a"), b = sites.Open("b");
  EXPECT_THAT(store::Merge(a, b, {}, NextStamp()), FailsWith(ErrorCode::kRecordDamaged, "does not pass its check"));
}

}  // namespace
}  // namespace striae::testing
