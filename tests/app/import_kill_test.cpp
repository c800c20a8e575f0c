// kill -9 of the real program at any call of it that changes a file, whatever the command: what it had acknowledged is
// there afterwards, and `striae check --repair` settles the rest.
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <random>

#include <gmock/gmock.h>

#include "tests/app/striae_program.h"
#include "tests/support/files.h"
#include "tests/support/ptp_photo.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_data.h"

namespace striae {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Ran;
using Words = std::vector<std::string>;

/// For the programs started while this lives.
class Environment {
 public:
  Environment(const std::string& name, const std::string& value) : name_(name) {
    ::setenv(name.c_str(), value.c_str(), 1);
  }
  ~Environment() { ::unsetenv(name_.c_str()); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  std::string name_;
};

/// A study with everything that the commands work on, made by the program itself.
class KilledProgram {
 public:
  KilledProgram() {
    Must(
        {"init", study_, "--protocol", "KILL-1", "--title", "Killed", "--sponsor", "Example Institute", "--site", "A"});
    std::ofstream(dir_ / "key.txt") << "four random words here\n";
    std::ofstream(dir_ / "person.json") << R"({"name": "Test^Subject", "birth_date": "1950-01-31"})";
    for (const char* subject : {"S001", "S002"}) {
      Do({"subject", "add", subject});
      Do({"consent", subject, "--given", "2026-05-01"});
    }
    session_ = Open("S001", "V1");
    other_session_ = Open("S002", "V1");
    Do({"user", "add", "anna", "--role", "investigator", "--full-name", "Test Investigator"});
    Do({"user", "passphrase", "anna", "--new-passphrase-file", Path("key.txt")});
    moved_ = Import("moved.jpg", session_).at("capture");
    const bool real = testing::HasTestData("practice/wound_0/visit_0.jpg");
    const std::string photo = real ? testing::TestData("practice/wound_0/visit_0.jpg").string() : Photo("wound.jpg");
    wound_ = Do({"import", "--session", session_, photo, "--as", "wound:W1"}).at("files").at(0).at("capture");
    if (real) {
      Do({"device", "add", "--serial", "6123456", "--range", "small"});
      Do({"calibration", "add", testing::TestData("practice/true_small.json").string(), "--device", "6123456",
          "--valid-from", "2026-05-01"});
    }
    Must({"restore", study_, Path("laptop"), "--branch"});
  }

  using Prepared =
      std::pair<Words, std::function<void()>>;  ///< the command, and what must hold once it has said "done"

  /// What is done in a round; preparations are not killed.
  Prepared Prepare(int what, const std::string& round) {
    const auto nothing = [] {};
    switch (what) {
      case 0:
      case 1: {  // twice: photographs matter most
        const std::string file = Photo(round + ".jpg");
        return {{"import", "--session", session_, file}, nothing};
      }
      case 2:
        return {{"subject", "add", "R" + round}, [=, this] { Do({"show", "R" + round}); }};
      case 3:
        return {{"session", "open", "--subject", "S001", "--visit", "V" + round}, [=, this] {
                  EXPECT_NE(Do({"session", "list"}).dump().find("\"V" + round + "\""), std::string::npos);
                }};
      case 4:
        Do({"subject", "add", "C" + round});
        return {{"consent", "C" + round, "--given", "2026-05-02"}, [=, this] {
                  EXPECT_EQ(Do({"show", "C" + round}).dump().find("2026-05-02") == std::string::npos, false);
                }};
      case 5:
        return {{"outline", wound_, Outline(round)}, nothing};
      case 6:
        Do({"outline", wound_, Outline(round)});
        return {{"process", "--session", session_}, nothing};
      case 7:
        return {{"query", "open", "S001", "--text", "question " + round}, [=, this] {
                  EXPECT_NE(Do({"query", "list"}).dump().find("question " + round), std::string::npos);
                }};
      case 8:
        return {{"sign", "S002", "--meaning", "reviewed", "--user", "anna", "--passphrase-file", Path("key.txt")},
                nothing};
      case 9: {
        const bool there = Do({"show", moved_}).dump().find(other_session_) != std::string::npos;
        return {{"reassign", moved_, "--to", there ? session_ : other_session_, "--reason", "logged wrongly", "--user",
                 "anna", "--passphrase-file", Path("key.txt")},
                nothing};
      }
      case 10:
        Must({"-C", Path("laptop"), "subject", "add", "L" + round});
        return {{"merge", Path("laptop")}, [=, this] { Do({"show", "L" + round}); }};
      case 11: {
        const std::string to = Path("backup" + round);
        return {{"backup", to}, [=] { Must({"-C", to, "check"}); }};
      }
      default:
        return {{"identity", "set", "S001", "--from", Path("person.json"), "--passphrase-file", Path("key.txt")},
                nothing};
    }
  }
  static constexpr int kKinds = 13;

  void Round(int what, const std::string& round, std::mt19937& random) {
    if (!calls_.contains(what)) calls_[what] = CallsOf(Prepare(what, "count" + std::to_string(what)).first);
    ASSERT_GT(calls_[what], 3) << "a command that changes the study";
    const auto [words, holds] = Prepare(what, round);
    const long at = static_cast<long>(random() % static_cast<unsigned long>(calls_[what]));
    SCOPED_TRACE(words.front() + ", killed at call " + std::to_string(at) + " of " + std::to_string(calls_[what]));
    const Ran ran = KilledAt(at, words);
    killed_ += ran.exit_code == 128 + SIGKILL ? 1 : 0;
    ASSERT_TRUE(ran.exit_code == 128 + SIGKILL || ran.exit_code == 0) << ran.exit_code << " " << ran.err;
    // A kill leaves warnings at most, and the repair settles them: its own check finds nothing afterwards.
    EXPECT_TRUE(Do({"check"}).at("passed"));
    EXPECT_EQ(Do({"check", "--repair"}).at("findings"), json::array());
    // --json is written when everything is done: whoever has read it may rely on it.
    if (words.front() == "import" && !ran.out.empty()) {
      for (const json& file : ran.Json().at("files")) acknowledged_.push_back(file.at("sha256"));
    }
    if (ran.exit_code == 0) holds();
    if (words.front() == "identity") {  // a try takes most of a second
      const json people = Do({"identity", "show", "--passphrase-file", Path("key.txt")});
      EXPECT_LE(people.at("identities").size(), 1U) << "the old file or the new one, never a broken one";
    }
    std::error_code ignored;
    fs::remove_all(Path("backup" + round), ignored);
  }
  /// Every photograph that was ever acknowledged is there.
  void ExpectAcknowledged() const {
    const std::string known = Do({"show", session_}).dump() + Do({"show", other_session_}).dump();
    for (const std::string& sha256 : acknowledged_) EXPECT_NE(known.find(sha256), std::string::npos) << sha256;
  }
  [[nodiscard]] int killed() const { return killed_; }

 private:
  [[nodiscard]] std::string Path(const std::string& name) const { return (dir_ / name).string(); }
  static json Must(Words words) {
    words.emplace_back("--json");
    const Ran ran = testing::Striae(words);
    EXPECT_EQ(ran.exit_code, 0) << words.front() << " " << words.back() << ": " << ran.err;
    return ran.Json();
  }
  json Do(Words words) const {
    words.insert(words.begin(), {"-C", study_});
    return Must(std::move(words));
  }
  [[nodiscard]] Ran Run(Words words) const {
    words.insert(words.begin(), {"-C", study_});
    words.emplace_back("--json");
    return testing::Striae(words);
  }
  [[nodiscard]] Ran KilledAt(long call, const Words& words) const {
    const Environment preload("LD_PRELOAD", STRIAE_KILLED_CALLS), at("STRIAE_TEST_KILL_AT", std::to_string(call));
    return Run(words);
  }
  [[nodiscard]] long CallsOf(const Words& words) const {
    const Environment preload("LD_PRELOAD", STRIAE_KILLED_CALLS), count("STRIAE_TEST_COUNT", Path("count"));
    const Ran ran = Run(words);
    EXPECT_EQ(ran.exit_code, 0) << words.front() << ": " << ran.err;
    return std::atol(testing::ReadText(Path("count")).c_str());
  }
  [[nodiscard]] std::string Open(const std::string& subject, const std::string& visit) const {
    return Do({"session", "open", "--subject", subject, "--visit", visit}).at("id");
  }
  /// A whole photograph that is another one for every name.
  [[nodiscard]] std::string Photo(const std::string& name) const {
    testing::PhotoOptions options;
    options.lens = name;
    testing::WriteBytes(dir_ / name, testing::MakeJpeg(options));
    return Path(name);
  }
  [[nodiscard]] json Import(const std::string& name, const std::string& session) const {
    return Do({"import", "--session", session, Photo(name)}).at("files").at(0);
  }
  /// A triangle near the middle, another one for every round.
  [[nodiscard]] std::string Outline(const std::string& round) const {
    const std::string x = std::to_string(1800 + std::hash<std::string>()(round) % 400);
    std::ofstream(dir_ / "outline.json") << "{\"polygon_px\": [[" << x << ",1200],[2400,1300],[2100,1600]]}";
    return Path("outline.json");
  }

  testing::TempDir dir_;
  std::string study_ = (dir_ / "trial").string();
  std::string session_, other_session_, moved_, wound_;
  Words acknowledged_;
  std::map<int, long> calls_;
  int killed_ = 0;
};

void Rounds(int count, std::uint32_t seed) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a library cannot be preloaded before a sanitizer's; the record's own kill test runs under them";
#endif
  KilledProgram program;
  std::mt19937 random(seed);
  for (int round = 0; round < count && !::testing::Test::HasFailure(); ++round) {
    program.Round(round % KilledProgram::kKinds, std::to_string(round), random);
  }
  program.ExpectAcknowledged();
  EXPECT_GT(program.killed(), count * 3 / 4) << "most rounds must really be cut short";
}

TEST(KilledProgram, AtAnyCallLosesNothingAcknowledged) { Rounds(16, 20261122); }
TEST(KilledProgramLong, TwoHundredTimesLosesNothingAcknowledged) { Rounds(200, 4); }

}  // namespace
}  // namespace striae
