// Two copies of a study that were worked on apart: what comes together does not depend on who takes in whom.
#include "store/merge.h"

#include <filesystem>
#include <map>
#include <optional>

#include <rapidcheck.h>

#include "store/backup.h"
#include "store/detail/database.h"
#include "store/detail/schema.h"
#include "tests/store/findings.h"
#include "tests/support/files.h"

namespace striae::testing {
namespace {

namespace fs = std::filesystem;
using store::detail::Database;
using store::detail::RowView;

/// Every row of every table with a trail, as text. Numbers and links included; audit rows are compared by the chains.
std::map<std::string, std::string> ContentOf(const fs::path& study) {
  Database database(study / "study.db", false);
  std::map<std::string, std::string> content;
  for (const std::string& table : store::detail::AuditedTables(database)) {
    database.Each("SELECT * FROM " + table, [&](const RowView& row) {
      std::string& text = content[table + " " + row.Text(0)];
      for (int i = 0; i < row.size(); ++i) text += row.NameOf(i) + "=" + row.OptionalText(i).value_or("NULL") + "|";
    });
  }
  return content;
}

/// The differences, for a person.
std::string Compare(const fs::path& a, const fs::path& b) {
  const auto left = ContentOf(a), right = ContentOf(b);
  std::string text;
  for (const auto& [key, value] : left) {
    const auto other = right.find(key);
    if (other == right.end()) text += "only left: " + key + " " + value + "\n";
    if (other != right.end() && other->second != value) text += key + ":\n  " + value + "\n  " + other->second + "\n";
  }
  for (const auto& [key, value] : right) {
    if (!left.contains(key)) text += "only right: " + key + " " + value + "\n";
  }
  return text;
}

/// A study with a subject and an open session, and its branch.
class Sites {
 public:
  Sites() {
    subject_ = study_.EnrolWithConsent("S001");
    session_ = study_.Open(subject_);
    capture_ = study_.Import(session_, "a photograph", "unassigned");
    outcome_ = *study_->AddReport(CountedId<ReportId>(), capture_.id, WoundReport(capture_, 3.5), NextStamp());
    study_.Close();
    Copy(study_.folder(), "a", std::nullopt);
    Copy(study_.folder(), "b", CountedUuid());
  }
  [[nodiscard]] fs::path At(const std::string& name) const { return study_.dir() / name; }
  void Copy(const fs::path& from, const std::string& name, std::optional<Uuid> branch) {
    store::RestoreOptions options;
    options.branch = branch;
    const auto restored = store::Restore(from, At(name), options, NextStamp());
    if (!restored) throw std::runtime_error(restored.error().Describe());
  }
  [[nodiscard]] store::Record Open(const std::string& name) const {
    auto record = store::Record::Open(At(name), NextStamp());
    if (!record) throw std::runtime_error(record.error().Describe());
    return *std::move(record);
  }
  store::MergeReport Merge(const std::string& into, const std::string& other) {
    auto mine = Open(into), theirs = Open(other);
    auto report = store::Merge(mine, theirs, {}, NextStamp());
    if (!report) throw std::runtime_error(report.error().Describe());
    const auto check = mine.Check();
    if (!check || !check->Passed()) {
      std::string text = "after the merge the check fails:";
      for (const auto& finding : check->findings) text += "\n" + finding.where + " " + finding.what;
      throw std::runtime_error(text);
    }
    return *report;
  }
  /// a takes in b, and in fresh copies b takes in a; then what differs.
  std::string BothWays() {
    Copy(At("a"), "a2", std::nullopt);
    Copy(At("b"), "b2", std::nullopt);
    Merge("a", "b");
    Merge("b2", "a2");
    return Compare(At("a"), At("b2"));
  }

  Subject subject_;
  Session session_;
  Capture capture_;
  store::Outcome outcome_;
  SmallStudy study_;
};

void Enrol(store::Record& record, const std::string& pseudonym) {
  const Subject subject{CountedId<SubjectId>(), pseudonym, record.Sites()->front().id, {}, {}};
  ASSERT_THAT(record.AddSubject(subject, NextStamp()), IsOk());
  ASSERT_THAT(record.GiveConsent(subject.id, {2026, 5, 1}, NextStamp()), IsOk());
}

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
  ASSERT_EQ(store::detail::Migrations().size(), 8U)
      << "there is a newer format: take back all after 7 in the next line";
  ASSERT_EQ(RawSql(sites.At("b") / "study.db",
                   "DROP INDEX audit_by_entity; DROP INDEX session_visit; DROP INDEX capture_role; PRAGMA "
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

/// One thing that a person does at one copy; few names, so that both copies collide often.
void Act(store::Record& record, const Sites& sites, int what) {
  const std::string few = std::to_string(what / 8 % 3);
  switch (what % 8) {
    case 0:
    case 1:
      (void)record.AddSubject({CountedId<SubjectId>(), "S10" + few, record.Sites()->front().id, {}, {}}, NextStamp());
      break;
    case 2:
    case 3:
      (void)record.AddCapture(SmallStudy::Photograph(sites.session_), Bytes("photo " + few), NextStamp());
      break;
    case 4:
      (void)record.SetRole(sites.capture_.id, *CaptureRole::Parse("wound:W" + few), "seen again", NextStamp());
      break;
    case 5:
      (void)record.AddReport(CountedId<ReportId>(), sites.capture_.id, WoundReport(sites.capture_, 1.0 + what),
                             NextStamp());
      break;
    case 6: {
      Session session = sites.session_;
      session.id = CountedId<SessionId>();
      (void)record.OpenSession(session, "V" + few, CountedId<VisitId>(), NextStamp());
      break;
    }
    default:
      (void)record.WithdrawConsent(sites.subject_.id, {2026, 5, 20}, "asked to stop", NextStamp());
      (void)record.GiveConsent(sites.subject_.id, {2026, 5, 21}, NextStamp());
  }
}

TEST(Merge, IsTheSameBothWaysAndTwiceIsOnceWhateverWasDone) {
  // Each case copies whole studies, so there are few of them, from rapidcheck's generator with fixed seeds.
  constexpr int kCases = 5, kSize = 14;
  const auto actions = rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 256));
  for (std::uint64_t seed = 1; seed <= kCases; ++seed) {
    const std::vector<int> at_a = actions(rc::Random(2 * seed), kSize).value();
    const std::vector<int> at_b = actions(rc::Random(2 * seed + 1), kSize).value();
    Sites sites;
    {
      auto a = sites.Open("a"), b = sites.Open("b");
      for (const int what : at_a) Act(a, sites, what);
      for (const int what : at_b) Act(b, sites, what);
    }
    ASSERT_EQ(sites.BothWays(), "") << "seed " << seed;
    const auto once = ContentOf(sites.At("a"));
    sites.Merge("a", "b");
    ASSERT_EQ(ContentOf(sites.At("a")), once) << "seed " << seed;
    sites.Merge("b", "a");
    ASSERT_EQ(Compare(sites.At("a"), sites.At("b")), "") << "seed " << seed;
  }
}

}  // namespace
}  // namespace striae::testing
