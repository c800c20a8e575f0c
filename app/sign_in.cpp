#include "app/sign_in.h"

#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include <termios.h>
#include <unistd.h>

#include "app/study.h"

namespace striae::app {
namespace {

termios echoing{};  // the terminal as it was; a signal's handler can reach nothing but what is static
constexpr std::array kEnding = {SIGINT, SIGTERM, SIGHUP, SIGQUIT};

void EchoAgainAndEnd(int number) {
  ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &echoing);
  ::signal(number, SIG_DFL);
  ::raise(number);
}

/// The terminal without echo as long as this lives; a signal that ends the program puts it back.
class Quiet {
 public:
  Quiet() {
    ::tcgetattr(STDIN_FILENO, &echoing);
    for (std::size_t i = 0; i < kEnding.size(); ++i) {
      struct sigaction end {};
      end.sa_handler = EchoAgainAndEnd;
      ::sigaction(kEnding[i], &end, &before_[i]);
    }
    termios quiet = echoing;
    quiet.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &quiet);
  }
  ~Quiet() {
    ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &echoing);
    for (std::size_t i = 0; i < kEnding.size(); ++i) ::sigaction(kEnding[i], &before_[i], nullptr);
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  std::array<struct sigaction, kEnding.size()> before_{};
};

void DropLineEnd(std::string& line) {
  if (line.ends_with('\r')) line.pop_back();
}

}  // namespace

void AddSignInOptions(CLI::App& command, SignInOptions& options) {
  command.add_option("--user", options.user, "Who does this (else STRIAE_USER, else the login name)");
  command.add_option("--passphrase-file", options.passphrase_file,
                     "File whose first line is the passphrase (else STRIAE_PASSPHRASE_FILE, else the terminal asks)");
}

std::filesystem::path PassphraseFile(const SignInOptions& options) {
  if (!options.passphrase_file.empty()) return options.passphrase_file;
  const char* named = std::getenv("STRIAE_PASSPHRASE_FILE");
  return named == nullptr ? std::filesystem::path() : std::filesystem::path(named);
}

Result<std::string> AskPassphrase(const std::filesystem::path& file, const std::string& prompt) {
  std::string line;
  if (!file.empty()) {
    std::ifstream stream(file);
    if (!std::getline(stream, line)) {
      return Fail(ErrorCode::kIo, "no passphrase can be read from " + file.string() + "; check --passphrase-file");
    }
    DropLineEnd(line);
    return line;
  }
  if (::isatty(STDIN_FILENO) == 0) {
    return Fail(ErrorCode::kUsage,
                "a passphrase is needed and there is no terminal to ask; name a file that holds it with "
                "--passphrase-file or STRIAE_PASSPHRASE_FILE");
  }
  bool typed = false;
  {
    const Quiet quiet;  // before the prompt: what is typed ahead is not shown either
    std::cerr << prompt << ": " << std::flush;
    typed = static_cast<bool>(std::getline(std::cin, line));
  }
  std::cerr << '\n';
  if (!typed) return Fail(ErrorCode::kUsage, "no passphrase was typed; nothing was changed");
  DropLineEnd(line);
  return line;
}

Result<std::string> AskNewPassphrase(const std::filesystem::path& file, const std::string& prompt) {
  auto passphrase = AskPassphrase(file, prompt);
  if (!passphrase || !file.empty()) return passphrase;
  const auto again = AskPassphrase({}, "Once more");
  if (!again) return Fail(again.error());
  if (*again != *passphrase) return Fail(ErrorCode::kUsage, "the two were not the same; nothing was changed");
  return passphrase;
}

Result<store::SignedIn> SignInFor(store::Record& record, const SignInOptions& options, store::Act act) {
  if (!options.user.empty()) ActAs(options.user);
  const store::Stamp stamp = NewStamp();
  const auto users = store::Users(record);
  if (!users) return Fail(users.error());
  if (users->empty()) {
    return Fail(ErrorCode::kRecordRefused,
                "to " + std::string(ToString(act)) +
                    " needs a user who signs in, and this study has none; add one with 'striae user add NAME --role "
                    "investigator' and 'striae user passphrase NAME'");
  }
  const auto user = store::UserByName(record, stamp.user);
  if (!user) return Fail(user.error(), "say who you are with --user");
  if (!store::May(user->role, act)) {
    return Fail(ErrorCode::kRecordRefused, user->name + " is " + std::string(ToString(user->role)) + " and may not " +
                                               std::string(ToString(act)) + "; see 'striae user list' for who may");
  }
  if (!user->has_passphrase) {
    return Fail(ErrorCode::kRecordRefused,
                user->name + " has no passphrase yet; set it with 'striae user passphrase " + user->name + "'");
  }
  const auto passphrase = AskPassphrase(PassphraseFile(options), "Passphrase of " + user->name);
  if (!passphrase) return Fail(passphrase.error());
  return store::SignIn(record, user->name, *passphrase, stamp);
}

}  // namespace striae::app
