// `striae lock`: nothing below it changes any more. `striae lock list`: what is locked.
#include "app/sign_in.h"
#include "app/study.h"
#include "store/json.h"

namespace striae::app {
namespace {

struct Options {
  std::string target, reason;
  SignInOptions sign_in;
};

Status Lock(Context& run, const Options& options) {
  if (options.target.empty()) {
    return Fail(ErrorCode::kUsage, "say what is locked: a pseudonym, the id of a visit or session, or study");
  }
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto target = FindTarget(*record, options.target);
  if (!target) return Fail(target.error());
  const auto by = SignInFor(*record, options.sign_in, store::Act::kLock);
  if (!by) return Fail(by.error());
  const auto id = NewId<store::LockId>();
  const Status locked = store::AddLock(*record, id, *target, options.reason, *by, NewStamp());
  if (!locked) return Fail(locked.error(), "locking");
  run.Output({{"id", id.ToString()}, {"about", {{"entity", target->entity}, {"id", target->id}}}},
             target->entity + " is locked; lock " + id.ToString());
  return {};
}

Status List(Context& run) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto locks = store::Locks(*record);
  if (!locks) return Fail(locks.error());
  nlohmann::json list = nlohmann::json::array();
  std::string text;
  for (const store::Lock& lock : *locks) {
    list.push_back(store::ToJson(lock));
    text += (text.empty() ? "" : "\n") + lock.id.ToString() + "  " + lock.target.entity + " " + lock.target.id + "  " +
            lock.by + " " + lock.at.ToString() + "  " + lock.reason;
  }
  run.Output({{"locks", list}}, text.empty() ? "nothing is locked" : text);
  return {};
}

}  // namespace

void AddCommand_lock(CLI::App& root, Context& context) {
  auto options = std::make_shared<Options>();
  CLI::App* lock = AddCommand(root, context, "lock", "Lock a study, subject, visit or session, or list what is locked",
                              "striae -C trial lock S001 --reason \"data are clean\" --user anna\n"
                              "  striae -C trial lock list");
  lock->add_option("TARGET", options->target, "A pseudonym, an id, or the word study");
  lock->add_option("--reason", options->reason, "Why");
  AddSignInOptions(*lock, options->sign_in);
  CLI::App* list = AddCommand(*lock, context, "list", "List the locks that hold", "striae -C trial lock list");
  OnRun(lock, context,
        [options, lock, list](Context& run) { return lock->got_subcommand(list) ? List(run) : Lock(run, *options); });
}

}  // namespace striae::app
