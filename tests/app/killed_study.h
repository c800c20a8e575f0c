// A study for tests that kill the program: every command that changes a study, with what it needs before and what must
// hold once it has said that it is done.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/app/striae_program.h"
#include "tests/support/temp_dir.h"

namespace striae::testing {

class KilledStudy {
 public:
  using Words = std::vector<std::string>;

  /// A study with subjects, sessions, a user who signs in, a photograph with its outline, and a copy on a laptop, made
  /// by the program itself.
  KilledStudy();

  /// A command to be killed; what prepares it is not.
  struct Command {
    Words words;
    std::function<void()> holds;  ///< once it has said that it is done; may be empty
    bool on_study = true;         ///< false: the words name their own study
  };
  /// The commands in turn; `round` makes their names unique.
  Command Prepare(std::size_t kind, const std::string& round);
  static std::size_t Kinds();

  [[nodiscard]] std::string Path(const std::string& name) const { return (dir_ / name).string(); }
  /// A command that must succeed.
  nlohmann::json Do(Words words) const;
  static nlohmann::json Must(Words words);
  [[nodiscard]] Ran Run(const Command& command) const;
  [[nodiscard]] const std::string& session() const { return session_; }
  [[nodiscard]] const std::string& other_session() const { return other_session_; }

 private:
  using Make = Command (KilledStudy::*)(const std::string& round);
  static const std::vector<Make>& All();
  Command Import(const std::string& round);
  Command ImportWithSidecar(const std::string& round);
  Command ImportBroken(const std::string& round);
  Command Watch(const std::string& round);
  Command Init(const std::string& round);
  Command AddSubject(const std::string& round);
  Command Consent(const std::string& round);
  Command Withdraw(const std::string& round);
  Command AddArm(const std::string& round);
  Command AssignArm(const std::string& round);
  Command PlanVisit(const std::string& round);
  Command ReplanVisit(const std::string& round);
  Command AddDevice(const std::string& round);
  Command AddCalibration(const std::string& round);
  Command OpenSession(const std::string& round);
  Command CloseSession(const std::string& round);
  Command ReopenSession(const std::string& round);
  Command Outline(const std::string& round);
  Command Process(const std::string& round);
  Command Exclude(const std::string& round);
  Command Note(const std::string& round);
  Command StrikeTreatment(const std::string& round);
  Command OpenQuery(const std::string& round);
  Command AnswerQuery(const std::string& round);
  Command AddUser(const std::string& round);
  Command SetPassphrase(const std::string& round);
  Command ChangeUser(const std::string& round);
  Command Sign(const std::string& round);
  Command Lock(const std::string& round);
  Command Unlock(const std::string& round);
  Command Reassign(const std::string& round);
  Command Merge(const std::string& round);
  Command Backup(const std::string& round);
  Command Restore(const std::string& round);
  Command Repair(const std::string& round);
  Command SetIdentity(const std::string& round);
  Command AddSite(const std::string& round);
  Command CorrectTreatment(const std::string& round);
  Command CorrectNote(const std::string& round);
  Command CloseQuery(const std::string& round);
  Command ReopenQuery(const std::string& round);
  Command ChangeIdentityPassphrase(const std::string& round);

  std::string Photo(const std::string& name) const;
  std::string WriteOutline(const std::string& round);
  [[nodiscard]] std::string Open(const std::string& subject, const std::string& visit) const;
  std::string Write(const std::string& name, const std::string& text) const;
  /// The words with the sign-in of the study's investigator behind them.
  [[nodiscard]] Words SignedIn(Words words) const;
  /// What must hold: the words' document has `text` in it.
  [[nodiscard]] std::function<void()> Shows(Words words, const std::string& text) const;

  TempDir dir_;
  std::string study_ = (dir_ / "trial").string();
  std::string session_, other_session_, moved_, wound_;
  int outlines_ = 0;
};

}  // namespace striae::testing
