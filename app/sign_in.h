// Who signs in, and with what: a passphrase is never on the command line and never in a log.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/command.h"
#include "store/record.h"
#include "store/users.h"

namespace striae::app {

/// As typed.
struct SignInOptions {
  std::string user;
  std::filesystem::path passphrase_file;
};

/// --user and --passphrase-file.
void AddSignInOptions(CLI::App& command, SignInOptions& options);

/// The first line of the file, without its end. `prompt` is shown on the terminal where there is no file
/// (--passphrase-file, else STRIAE_PASSPHRASE_FILE) and the answer is not echoed, also when a signal ends the program
/// meanwhile. kUsage when there is neither, and when the terminal ends (Ctrl-D).
Result<std::string> AskPassphrase(const std::filesystem::path& file, const std::string& prompt);
/// One that is to be set: at the terminal it is typed twice; kUsage when the two differ.
Result<std::string> AskNewPassphrase(const std::filesystem::path& file, const std::string& prompt);
/// --passphrase-file, else STRIAE_PASSPHRASE_FILE; empty when neither is given.
std::filesystem::path PassphraseFile(const SignInOptions& options);

/// Signs in --user, else STRIAE_USER, else the login name; kRecordRefused, with what to do, in a study without users,
/// for a role without the right (asked before the passphrase), and for a wrong passphrase.
Result<store::SignedIn> SignInFor(store::Record& record, const SignInOptions& options, store::Act act);

}  // namespace striae::app
