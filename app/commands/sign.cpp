// `striae sign` and `striae signatures`: who stands for what, and whether it is still the same.
#include "app/sign_in.h"
#include "app/study.h"
#include "store/json.h"

namespace striae::app {
namespace {

struct Options {
  std::string target, meaning;
  SignInOptions sign_in;
};

std::string LineOf(const store::Signature& signature) {
  return signature.at.ToString() + "  " + std::string(ToString(signature.meaning)) + " by " + signature.signer + " (" +
         signature.role + ")  " + signature.target.entity + " " + signature.target.id + "  " +
         std::string(ToString(signature.state));
}

Status Sign(Context& run, const Options& options) {
  const auto meaning = store::ParseMeaning(options.meaning);
  if (!meaning) return Fail(meaning.error());
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto target = FindTarget(*record, options.target);
  if (!target) return Fail(target.error());
  const auto by = SignInFor(*record, options.sign_in, store::Act::kSign);
  if (!by) return Fail(by.error());
  const auto signature = store::Sign(*record, NewId<store::SignatureId>(), *target, *meaning, *by, NewStamp());
  if (!signature) return Fail(signature.error(), "signing");
  run.Output(store::ToJson(*signature), LineOf(*signature));
  return {};
}

Status List(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  std::optional<std::string> only;
  if (!options.target.empty()) {
    const auto target = FindTarget(*record, options.target);
    if (!target) return Fail(target.error());
    only = target->id;
  }
  const auto signatures = store::Signatures(*record, only);
  if (!signatures) return Fail(signatures.error());
  nlohmann::json list = nlohmann::json::array();
  std::string text;
  for (const store::Signature& signature : *signatures) {
    list.push_back(store::ToJson(signature));
    text += (text.empty() ? "" : "\n") + LineOf(signature);
  }
  run.Output({{"signatures", list}}, text.empty() ? "no signatures yet" : text);
  return {};
}

}  // namespace

void AddCommand_sign(CLI::App& root, Context& context) {
  auto options = std::make_shared<Options>();
  CLI::App* sign = AddCommand(root, context, "sign", "Sign a study, subject, visit, session or capture as it is now",
                              "striae -C trial sign S001 --meaning approved --user anna");
  sign->add_option("TARGET", options->target, "A pseudonym, an id, or the word study")->required();
  sign->add_option("--meaning", options->meaning, "reviewed or approved")->required();
  AddSignInOptions(*sign, options->sign_in);
  OnRun(sign, context, [options](Context& run) { return Sign(run, *options); });
  CLI::App* list = AddCommand(root, context, "signatures", "List the signatures: valid, broken by a change, or voided",
                              "striae -C trial signatures");
  list->add_option("TARGET", options->target, "Only those of this subject, visit, session or capture");
  OnRun(list, context, [options](Context& run) { return List(run, *options); });
}

}  // namespace striae::app
