// `striae subject add|list`: subjects by pseudonym. Names of people are never entered here.
#include "app/study.h"
#include "store/json.h"

namespace striae::app {
namespace {

struct Options {
  std::string pseudonym, site;
};

Result<SiteId> ChooseSite(store::Record& record, const std::string& code) {
  const auto sites = record.Sites();
  if (!sites) return Fail(sites.error());
  if (code.empty() && sites->size() == 1) return sites->front().id;
  std::string known;
  for (const Site& site : *sites) {
    if (site.code == code) return site.id;
    known += " " + site.code;
  }
  return Fail(ErrorCode::kUsage, "no site '" + code.substr(0, 40) + "'; --site is one of:" + known);
}

Status Add(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto site = ChooseSite(*record, options.site);
  if (!site) return Fail(site.error());
  const Subject subject{NewId<SubjectId>(), options.pseudonym, *site, {}, {}};
  if (const Status added = record->AddSubject(subject, NewStamp()); !added) {
    return Fail(added.error(), "adding a subject");
  }
  run.Output(store::ToJson(subject),
             "subject " + subject.pseudonym + "; next: striae consent " + subject.pseudonym + " --given DATE");
  return {};
}

std::string LineOf(const Subject& subject) {
  std::string line = subject.pseudonym + "  ";
  if (subject.consent_withdrawn) return line + "consent withdrawn " + subject.consent_withdrawn->ToString();
  if (subject.consent_given) return line + "consent given " + subject.consent_given->ToString();
  return line + "no consent";
}

Status List(Context& run) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto subjects = record->Subjects();
  if (!subjects) return Fail(subjects.error());
  nlohmann::json list = nlohmann::json::array();
  std::string text;
  for (const Subject& subject : *subjects) {
    list.push_back(store::ToJson(subject));
    text += (text.empty() ? "" : "\n") + LineOf(subject);
  }
  run.Output({{"subjects", list}}, text.empty() ? "no subjects yet" : text);
  return {};
}

}  // namespace

void AddCommand_subject(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "subject", "Subjects of the study, by pseudonym");
  auto options = std::make_shared<Options>();
  CLI::App* add = AddCommand(group, context, "add", "Enrol a subject under a pseudonym (never a name)",
                             "striae -C trial subject add S001");
  add->add_option("PSEUDONYM", options->pseudonym, "1 to 32 letters, digits, '-', '_' or '.'")->required();
  add->add_option("--site", options->site, "Code of the subject's site (needed when the study has several)");
  OnRun(add, context, [options](Context& run) { return Add(run, *options); });

  CLI::App* list =
      AddCommand(group, context, "list", "List the subjects and their consent", "striae -C trial subject list");
  OnRun(list, context, List);
}

}  // namespace striae::app
