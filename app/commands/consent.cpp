// `striae consent`: a subject's consent and its withdrawal.
#include <algorithm>

#include "app/sign_in.h"
#include "app/study.h"
#include "store/json.h"

namespace striae::app {
namespace {

struct Options {
  std::string pseudonym, given, withdrawn, reason;
  SignInOptions sign_in;
};

/// A withdrawal must always be possible: sign-in is asked for only where a user could sign in.
Status SignInWherePossible(store::Record& record, const SignInOptions& options) {
  const auto users = store::Users(record);
  if (!users) return Fail(users.error());
  const bool possible = std::any_of(users->begin(), users->end(), [](const store::User& user) {
    return user.active && user.has_passphrase && store::May(user.role, store::Act::kWithdraw);
  });
  if (!possible) return {};
  const auto by = SignInFor(record, options, store::Act::kWithdraw);
  return by ? Status{} : Status(Fail(by.error()));
}

Status Enter(store::Record& record, const SubjectId& id, const Options& options, const Date& date,
             const store::Stamp& stamp) {
  if (!options.given.empty()) return record.GiveConsent(id, date, stamp);
  return record.WithdrawConsent(id, date, options.reason, stamp);
}

Status Run(Context& run, const Options& options) {
  const auto date = Date::Parse(options.given.empty() ? options.withdrawn : options.given);
  if (!date) return Fail(date.error(), options.given.empty() ? "--withdrawn" : "--given");
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto subject = record->SubjectByPseudonym(options.pseudonym);
  if (!subject) return Fail(subject.error());
  if (!options.withdrawn.empty()) {
    if (const Status by = SignInWherePossible(*record, options.sign_in); !by) return Fail(by.error());
  }
  const store::Stamp stamp = NewStamp();
  if (date->DaysSinceEpoch() > Date::Of(stamp.now).DaysSinceEpoch() + 1) {
    run.Note("note: " + date->ToString() + " lies in the future of this machine's clock");
  }
  if (const Status entered = Enter(*record, subject->id, options, *date, stamp); !entered) {
    return Fail(entered.error(), "entering consent");
  }
  const auto now = record->SubjectById(subject->id);
  if (!now) return Fail(now.error());
  run.Output(store::ToJson(*now), "subject " + now->pseudonym + ": consent " +
                                      (now->HasActiveConsent() ? "given " + now->consent_given->ToString()
                                                               : "withdrawn " + now->consent_withdrawn->ToString()));
  return {};
}

}  // namespace

void AddCommand_consent(CLI::App& root, Context& context) {
  CLI::App* command = AddCommand(root, context, "consent", "Record that a subject gave or withdrew consent",
                                 "striae -C trial consent S001 --given 2026-05-04");
  auto options = std::make_shared<Options>();
  command->add_option("PSEUDONYM", options->pseudonym, "The subject")->required();
  CLI::Option* given = command->add_option("--given", options->given, "Day on which consent was given (2026-05-04)");
  CLI::Option* withdrawn =
      command->add_option("--withdrawn", options->withdrawn, "Day on which it was withdrawn; photographs stop");
  given->excludes(withdrawn);
  command->add_option("--reason", options->reason, "Why it was withdrawn, if the subject says so")->needs(withdrawn);
  AddSignInOptions(*command, options->sign_in);
  OnRun(command, context, [options](Context& run) -> Status {
    if (options->given.empty() && options->withdrawn.empty()) {
      return Fail(ErrorCode::kUsage, "say --given DATE or --withdrawn DATE");
    }
    return Run(run, *options);
  });
}

}  // namespace striae::app
