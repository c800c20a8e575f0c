// kill -9 of the real program at any call of it that changes a file, whatever the command: what it had acknowledged is
// there afterwards, and `striae check --repair` settles the rest.
#include <csignal>
#include <cstdlib>
#include <map>
#include <random>
#include <regex>

#include <gmock/gmock.h>

#include "tests/app/killed_study.h"
#include "tests/support/files.h"

namespace striae::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Command = KilledStudy::Command;

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

class Rounds {
 public:
  explicit Rounds(std::uint32_t seed) : random_(seed) {}

  void Round(std::size_t kind, const std::string& round) {
    if (!calls_.contains(kind)) calls_[kind] = CallsOf(study_.Prepare(kind, "0" + std::to_string(kind)));
    ASSERT_GT(calls_[kind], 3) << "a command that changes a file";
    const Command command = study_.Prepare(kind, round);
    const long at = static_cast<long>(random_() % static_cast<unsigned long>(calls_[kind]));
    SCOPED_TRACE("round " + round + ", " + ::testing::PrintToString(command.words) + " killed at call " +
                 std::to_string(at) + " of " + std::to_string(calls_[kind]));
    const Ran ran = KilledAt(at, command);
    const bool was_killed = ran.exit_code == 128 + SIGKILL;
    ASSERT_TRUE(was_killed || IsDone(command, ran)) << ran.exit_code << " " << ran.err;
    killed_ += was_killed ? 1 : 0;
    Settle();
    Acknowledge(command, ran);
    if (!was_killed && command.holds) command.holds();
    if (!command.on_study || command.words.front() == "backup") DoAgain(command, was_killed);
  }
  /// Every photograph that was ever acknowledged is there, whole.
  void ExpectAcknowledged() const {
    std::string known;
    for (const std::string& session : {study_.session(), study_.other_session()}) {
      known += study_.Do({"show", session}).dump();
    }
    for (const std::string& id : acknowledged_) EXPECT_THAT(known, ::testing::HasSubstr(id));
    const json people = study_.Do({"identity", "show", "--passphrase-file", study_.Path("key.txt")});
    EXPECT_EQ(people.at("identities").size(), 1U) << "the old file or the new one, never a broken one";
  }
  [[nodiscard]] int killed() const { return killed_; }
  [[nodiscard]] std::size_t acknowledged() const { return acknowledged_.size(); }

 private:
  /// A kill leaves warnings at most, and the repair settles them: its own check finds nothing afterwards.
  void Settle() const {
    const json check = study_.Do({"check"});
    EXPECT_TRUE(check.at("passed")) << check.dump(1);
    if (check.at("findings").empty()) return;
    EXPECT_EQ(study_.Do({"check", "--repair"}).at("findings"), json::array());
  }
  /// Each photograph is acknowledged by its own line, "...: added as ID ...", when it is in the record.
  void Acknowledge(const Command& command, const Ran& ran) {
    const std::string& word = command.words.front();
    if (word != "import" && word != "watch") return;
    static const std::regex line("added as ([0-9a-f-]{36})");
    for (std::sregex_iterator it(ran.err.begin(), ran.err.end(), line), end; it != end; ++it) {
      acknowledged_.push_back((*it)[1]);
    }
  }
  /// A folder that a killed program was making is no hindrance: it is refused by name or made new elsewhere.
  void DoAgain(const Command& command, bool was_killed) const {
    const std::string folder = command.words[command.words.front() == "restore" ? 2 : 1];
    if (was_killed && fs::exists(fs::path(folder) / "study.db") && !fs::exists(fs::path(folder) / "UNFINISHED")) {
      EXPECT_TRUE(KilledStudy::Must({"-C", folder, "check"}).at("passed")) << "what looks whole is whole";
    }
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    EXPECT_EQ(study_.Run(command).exit_code, 0) << "once the rest is out of the way, it works";
    fs::remove_all(folder, ignored);
  }
  [[nodiscard]] Ran KilledAt(long call, const Command& command) const {
    const Environment preload("LD_PRELOAD", STRIAE_KILLED_CALLS), at("STRIAE_TEST_KILL_AT", std::to_string(call));
    return study_.Run(command);
  }
  [[nodiscard]] long CallsOf(const Command& command) const {
    const Environment preload("LD_PRELOAD", STRIAE_KILLED_CALLS), count("STRIAE_TEST_COUNT", study_.Path("count"));
    const Ran ran = study_.Run(command);
    EXPECT_TRUE(IsDone(command, ran)) << ::testing::PrintToString(command.words) << ": " << ran.err;
    return std::atol(ReadText(study_.Path("count")).c_str());
  }
  /// A photograph without a number, or a broken one, is settled in the record too, and the exit code says so.
  static bool IsDone(const Command& command, const Ran& ran) {
    const bool broken = command.words.back().find("broken") != std::string::npos;
    return ran.exit_code == (broken ? 1 : 0) || (command.words.front() == "process" && ran.exit_code == 1);
  }

  KilledStudy study_;
  std::mt19937 random_;
  std::vector<std::string> acknowledged_;
  std::map<std::size_t, long> calls_;
  int killed_ = 0;
};

void RunRounds(std::size_t count, std::size_t first, std::uint32_t seed) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a library cannot be preloaded before a sanitizer's; the record's own kill test runs under them";
#endif
  Rounds rounds(seed);
  for (std::size_t round = 0; round < count && !::testing::Test::HasFailure(); ++round) {
    rounds.Round((first + round) % KilledStudy::Kinds(), std::to_string(round + 100));
  }
  rounds.ExpectAcknowledged();
  EXPECT_GT(rounds.killed(), static_cast<int>(count) * 3 / 4) << "most rounds must really be cut short";
  if (count > KilledStudy::Kinds()) {
    EXPECT_GT(rounds.acknowledged(), count / 20) << "some kills must come between photographs";
  }
  std::cout << count << " rounds, " << rounds.killed() << " killed, " << rounds.acknowledged()
            << " photographs acknowledged and there\n";
}

TEST(KilledProgram, AtAnyCallLosesNothingAcknowledged) { RunRounds(12, 0, 20261122); }
TEST(KilledProgramLong, TwoHundredTimesLosesNothingAcknowledged) { RunRounds(200, 0, 4); }

}  // namespace
}  // namespace striae::testing
