// A passphrase typed at a real terminal: asked for, never shown, and the terminal as it was afterwards.
#include <csignal>
#include <cstdlib>

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "tests/app/import_study.h"

namespace striae {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kPassphrase = "four random words here";

/// The program at a terminal of its own. The terminal stays when the program has ended.
class AtATerminal {
 public:
  explicit AtATerminal(const std::vector<std::string>& arguments) {
    const std::string program = std::string(STRIAE_BINARY_DIR) + "/striae";
    std::vector<char*> words = {const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    char name[64] = {};
    child_ = ::forkpty(&keyboard_, name, nullptr, nullptr);
    if (child_ == 0) {
      ::unsetenv("STRIAE_PASSPHRASE_FILE");
      ::execv(program.c_str(), words.data());
      ::_exit(127);
    }
    terminal_ = ::open(name, O_RDWR | O_NOCTTY);
  }
  ~AtATerminal() {
    if (child_ > 0) ::kill(child_, SIGKILL);
    (void)Ended();
    ::close(terminal_);
    ::close(keyboard_);
  }
  AtATerminal(const AtATerminal&) = delete;
  AtATerminal& operator=(const AtATerminal&) = delete;

  /// Reads until the screen shows `words`; false when they do not come.
  bool Shows(const std::string& words) {
    while (screen_.find(words, seen_) == std::string::npos) {
      if (!Read(20'000)) return false;
    }
    seen_ = screen_.find(words, seen_) + words.size();
    return true;
  }
  void Type(const std::string& keys) const {
    ASSERT_EQ(::write(keyboard_, keys.data(), keys.size()), ssize_t(keys.size()));
  }
  [[nodiscard]] bool Echoes() const {
    termios now{};
    ::tcgetattr(terminal_, &now);
    return (now.c_lflag & ECHO) != 0;
  }
  /// Waits for the end: the exit code, or minus the signal.
  int Ended() {
    if (child_ <= 0) return 0;
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = 0;
    while (Read(0)) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  [[nodiscard]] const std::string& screen() const { return screen_; }

 private:
  bool Read(int patience_ms) {
    pollfd wait{keyboard_, POLLIN, 0};
    char block[512];
    if (::poll(&wait, 1, patience_ms) <= 0) return false;
    const ssize_t count = ::read(keyboard_, block, sizeof block);
    if (count > 0) screen_.append(block, static_cast<std::size_t>(count));
    return count > 0;
  }
  int keyboard_ = -1, terminal_ = -1;
  pid_t child_ = 0;
  std::string screen_;
  std::size_t seen_ = 0;
};

class Passphrase : public testing::ProgramStudy {
 protected:
  void SetUp() override {
    ProgramStudy::SetUp();
    Do({"user", "add", "anna", "--role", "investigator"});
  }
  [[nodiscard]] std::vector<std::string> SetIt() const { return {"-C", study_, "user", "passphrase", "anna"}; }
  [[nodiscard]] std::vector<std::string> Sign() const {
    return {"-C", study_, "sign", "S001", "--meaning", "approved", "--user", "anna"};
  }
  void GiveOne() const {
    Do({"user", "passphrase", "anna", "--passphrase-file", Write("key.txt", std::string(kPassphrase) + "\n")});
  }
};

TEST_F(Passphrase, IsTypedTwiceWhenItIsSetAndOnceToSign) {
  {
    AtATerminal at(SetIt());
    ASSERT_TRUE(at.Shows("New passphrase of anna: ")) << at.screen();
    EXPECT_FALSE(at.Echoes());
    at.Type(std::string(kPassphrase) + "\n");
    ASSERT_TRUE(at.Shows("Once more: ")) << at.screen();
    EXPECT_FALSE(at.Echoes());
    at.Type(std::string(kPassphrase) + "\n");
    EXPECT_EQ(at.Ended(), 0) << at.screen();
    EXPECT_THAT(at.screen(), Not(HasSubstr("random")));
    EXPECT_TRUE(at.Echoes());
  }
  AtATerminal at(Sign());
  ASSERT_TRUE(at.Shows("Passphrase of anna: ")) << at.screen();
  EXPECT_FALSE(at.Echoes());
  at.Type(std::string(kPassphrase) + "\n");
  EXPECT_EQ(at.Ended(), 0) << at.screen();
  EXPECT_THAT(at.screen(), HasSubstr("approved by anna"));
  EXPECT_THAT(at.screen(), Not(HasSubstr("random")));
  EXPECT_EQ(Do({"signatures"}).at("signatures").size(), 1U);
}

TEST_F(Passphrase, TypedDifferentlyTheSecondTimeIsNotSet) {
  AtATerminal at(SetIt());
  ASSERT_TRUE(at.Shows("New passphrase of anna: "));
  at.Type("four random words here\n");
  ASSERT_TRUE(at.Shows("Once more: "));
  at.Type("four random words there\n");
  EXPECT_EQ(at.Ended(), 2);
  EXPECT_THAT(at.screen(), HasSubstr("not the same"));
  EXPECT_FALSE(Do({"user", "list"}).at("users").at(0).at("has_passphrase"));
}

TEST_F(Passphrase, ThatIsWrongSignsNothing) {
  GiveOne();
  AtATerminal at(Sign());
  ASSERT_TRUE(at.Shows("Passphrase of anna: "));
  at.Type("four other words here\n");
  EXPECT_EQ(at.Ended(), 1);
  EXPECT_THAT(at.screen(), Not(HasSubstr("other words")));
  EXPECT_TRUE(Do({"signatures"}).at("signatures").empty());
}

TEST_F(Passphrase, AnInterruptedPromptLeavesATerminalThatEchoes) {
  GiveOne();
  {
    AtATerminal at(Sign());
    ASSERT_TRUE(at.Shows("Passphrase of anna: "));
    at.Type("half a pass\x03");  // Ctrl-C
    EXPECT_EQ(at.Ended(), -SIGINT);
    EXPECT_TRUE(at.Echoes());
  }
  {
    AtATerminal at(Sign());
    ASSERT_TRUE(at.Shows("Passphrase of anna: "));
    at.Type("\x04");  // Ctrl-D
    EXPECT_EQ(at.Ended(), 2);
    EXPECT_THAT(at.screen(), HasSubstr("no passphrase was typed"));
    EXPECT_TRUE(at.Echoes());
  }
  EXPECT_TRUE(Do({"signatures"}).at("signatures").empty());
}

/// Nobody could open the file again after a slip of the finger.
TEST_F(Passphrase, OfIdentitiesIsTypedTwiceTheFirstTime) {
  const std::string person = Write("person.json", R"({"name": "Test^Subject"})");
  const std::vector<std::string> set = {"-C", study_, "identity", "set", "S001", "--from", person};
  for (const bool first : {true, false}) {
    AtATerminal at(set);
    ASSERT_TRUE(at.Shows(first ? "New passphrase of identity.striae: " : "Passphrase of identity.striae: "))
        << at.screen();
    at.Type(std::string(kPassphrase) + "\n");
    if (first) {
      ASSERT_TRUE(at.Shows("Once more: ")) << at.screen();
      at.Type(std::string(kPassphrase) + "\n");
    }
    EXPECT_EQ(at.Ended(), 0) << at.screen();
    EXPECT_THAT(at.screen(), Not(HasSubstr("random")));
  }
}

}  // namespace
}  // namespace striae
