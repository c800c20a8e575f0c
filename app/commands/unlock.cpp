// `striae unlock`: ends a lock with a reason; signatures on what was locked are void.
#include "app/sign_in.h"
#include "app/study.h"
#include "store/locks.h"

namespace striae::app {
namespace {

struct Options {
  std::string target, reason;
  SignInOptions sign_in;
};

/// By the lock's own id, or by what is locked.
Result<store::LockId> LockOf(store::Record& record, const std::string& text) {
  const auto target = FindTarget(record, text);
  if (!target) return Fail(target.error());
  const auto locks = store::Locks(record);
  if (!locks) return Fail(locks.error());
  for (const store::Lock& lock : *locks) {
    if (lock.id.ToString() == target->id || lock.target.id == target->id) return lock.id;
  }
  return Fail(ErrorCode::kNotFound, "no lock holds on " + text.substr(0, 40) + "; see 'striae lock list'");
}

Status Run(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto lock = LockOf(*record, options.target);
  if (!lock) return Fail(lock.error());
  const auto by = SignInFor(*record, options.sign_in, store::Act::kUnlock);
  if (!by) return Fail(by.error());
  const auto id = NewId<store::UnlockId>();
  const Status unlocked = store::Unlock(*record, id, *lock, options.reason, *by, NewStamp());
  if (!unlocked) return Fail(unlocked.error(), "unlocking");
  run.Output({{"id", id.ToString()}, {"lock", lock->ToString()}}, "unlocked; signatures on it are void");
  return {};
}

}  // namespace

void AddCommand_unlock(CLI::App& root, Context& context) {
  auto options = std::make_shared<Options>();
  CLI::App* command = AddCommand(root, context, "unlock", "End a lock with a reason; signatures become void",
                                 "striae -C trial unlock S001 --reason \"wrong date found\" --user anna");
  command->add_option("TARGET", options->target, "What is locked, or the lock's id")->required();
  command->add_option("--reason", options->reason, "Why")->required();
  AddSignInOptions(*command, options->sign_in);
  OnRun(command, context, [options](Context& run) { return Run(run, *options); });
}

}  // namespace striae::app
