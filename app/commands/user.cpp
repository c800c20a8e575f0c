// `striae user add|list|passphrase|change`: who works in the study, and in which role.
#include "app/sign_in.h"
#include "app/study.h"
#include "store/json.h"

namespace striae::app {
namespace {

struct Options {
  std::string name, full_name, role, reason;
  std::filesystem::path new_passphrase_file;
  bool deactivate = false, activate = false;
  SignInOptions sign_in;
};

/// An administrator's sign-in, where the study asks for one.
Result<std::optional<store::SignedIn>> Manager(store::Record& record, const SignInOptions& options) {
  const auto open = store::UsersAreOpen(record);
  if (!open) return Fail(open.error());
  if (!options.user.empty()) ActAs(options.user);
  if (*open) return std::optional<store::SignedIn>();
  auto by = SignInFor(record, options, store::Act::kManageUsers);
  if (!by) return Fail(by.error());
  return std::optional(*std::move(by));
}

Status Finish(Context& run, store::Record& record, const std::string& name, const std::string& text) {
  const auto user = store::UserByName(record, name);
  if (!user) return Fail(user.error());
  run.Output(store::ToJson(*user), text);
  return {};
}

Status Add(Context& run, const Options& options) {
  const auto role = store::ParseRole(options.role);
  if (!role) return Fail(role.error());
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto by = Manager(*record, options.sign_in);
  if (!by) return Fail(by.error());
  // Without a sign-in there is one passphrase only that can be meant.
  std::filesystem::path file = options.new_passphrase_file;
  if (file.empty() && !*by) file = PassphraseFile(options.sign_in);
  std::string passphrase;
  if (!file.empty()) {
    const auto asked = AskPassphrase(file, "");
    if (!asked) return Fail(asked.error());
    passphrase = *asked;
    if (passphrase.size() < 8) return Fail(ErrorCode::kUsage, "a passphrase needs at least 8 characters");
  }
  const store::User user{NewId<store::UserId>(), options.name, options.full_name, *role, true, false};
  if (const Status added = store::AddUser(*record, user, *by, NewStamp()); !added) {
    return Fail(added.error(), "adding a user");
  }
  if (!file.empty()) {
    const Status set = store::SetPassphrase(*record, user.id, passphrase, NewUuid(), *by, NewStamp());
    if (!set) return Fail(set.error(), "setting the passphrase");
  }
  return Finish(run, *record, user.name,
                "user " + user.name + " (" + options.role + ")" +
                    (file.empty() ? "; to sign in: striae user passphrase " + user.name : ""));
}

Status List(Context& run) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto users = store::Users(*record);
  if (!users) return Fail(users.error());
  nlohmann::json list = nlohmann::json::array();
  std::string text;
  for (const store::User& user : *users) {
    list.push_back(store::ToJson(user));
    text += (text.empty() ? "" : "\n") + user.name + "  " + std::string(ToString(user.role)) + "  " + user.full_name +
            (user.active ? "" : "  not active") + (user.has_passphrase ? "" : "  no passphrase");
  }
  run.Output({{"users", list}}, text.empty() ? "no users yet" : text);
  return {};
}

/// The user's own, after the old one; or set by an administrator, or the first while there is none.
Result<std::optional<store::SignedIn>> MaySet(store::Record& record, const store::User& user,
                                              const SignInOptions& options) {
  if (!options.user.empty()) ActAs(options.user);
  if (!user.has_passphrase || NewStamp().user != user.name) return Manager(record, options);
  const auto old = AskPassphrase(PassphraseFile(options), "Old passphrase of " + user.name);
  if (!old) return Fail(old.error());
  auto by = store::SignIn(record, user.name, *old, NewStamp());
  if (!by) return Fail(by.error());
  return std::optional(*std::move(by));
}

Status Passphrase(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto user = store::UserByName(*record, options.name);
  if (!user) return Fail(user.error());
  const auto by = MaySet(*record, *user, options.sign_in);
  if (!by) return Fail(by.error());
  std::filesystem::path file = options.new_passphrase_file;
  if (file.empty() && !*by) file = PassphraseFile(options.sign_in);
  const auto passphrase = AskNewPassphrase(file, "New passphrase of " + user->name);
  if (!passphrase) return Fail(passphrase.error());
  const Status set = store::SetPassphrase(*record, user->id, *passphrase, NewUuid(), *by, NewStamp());
  if (!set) return Fail(set.error(), "setting the passphrase");
  return Finish(run, *record, user->name, "passphrase of " + user->name + " set");
}

Status Change(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto user = store::UserByName(*record, options.name);
  if (!user) return Fail(user.error());
  const auto by = Manager(*record, options.sign_in);
  if (!by) return Fail(by.error());
  if (!options.role.empty()) {
    const auto role = store::ParseRole(options.role);
    if (!role) return Fail(role.error());
    const Status changed = store::ChangeRole(*record, user->id, *role, options.reason, *by, NewStamp());
    if (!changed) return Fail(changed.error());
  }
  if (options.deactivate || options.activate) {
    const Status changed = store::SetActive(*record, user->id, options.activate, options.reason, *by, NewStamp());
    if (!changed) return Fail(changed.error());
  }
  return Finish(run, *record, user->name, "user " + user->name + " changed");
}

}  // namespace

void AddCommand_user(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "user", "Users of the study and their roles");
  auto options = std::make_shared<Options>();
  CLI::App* add = AddCommand(group, context, "add", "Add a user",
                             "striae -C trial user add anna --role investigator --full-name \"Test Investigator\"");
  add->add_option("NAME", options->name, "As it stands in the audit trail")->required();
  add->add_option("--role", options->role, "coordinator, clinician, investigator, monitor or administrator")
      ->required();
  add->add_option("--full-name", options->full_name, "As it is printed with a signature");
  CLI::App* list = AddCommand(group, context, "list", "List the users", "striae -C trial user list");
  CLI::App* passphrase = AddCommand(group, context, "passphrase", "Set the passphrase that a user signs in with",
                                    "striae -C trial user passphrase anna");
  passphrase->add_option("NAME", options->name, "The user")->required();
  CLI::App* change =
      AddCommand(group, context, "change", "Change a user's role, or let a user work no more",
                 "striae -C trial user change anna --role monitor --reason \"new function in the study\"");
  change->add_option("NAME", options->name, "The user")->required();
  change->add_option("--role", options->role, "The new role");
  change->add_flag("--deactivate", options->deactivate, "The user can no longer sign in")
      ->excludes(change->add_flag("--activate", options->activate, "The user can sign in again"));
  change->add_option("--reason", options->reason, "Why")->required();
  for (CLI::App* command : {add, passphrase, change}) AddSignInOptions(*command, options->sign_in);
  for (CLI::App* command : {add, passphrase}) {
    command->add_option("--new-passphrase-file", options->new_passphrase_file,
                        "File whose first line is the new passphrase (--passphrase-file has that of who signs in)");
  }
  OnRun(add, context, [options](Context& run) { return Add(run, *options); });
  OnRun(list, context, List);
  OnRun(passphrase, context, [options](Context& run) { return Passphrase(run, *options); });
  OnRun(change, context, [options](Context& run) { return Change(run, *options); });
}

}  // namespace striae::app
