// `striae treatment add|correct|strike|list`: what was done to a subject, and when.
#include "app/study.h"
#include "store/annotations.h"
#include "store/json.h"

namespace striae::app {
namespace {

struct Options {
  std::string target, date, text, reason;
};

Status Add(Context& run, const Options& options) {
  const auto date = Date::Parse(options.date);
  if (!date) return Fail(date.error(), "--date");
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto subject = record->SubjectByPseudonym(options.target);
  if (!subject) return Fail(subject.error());
  const store::Treatment treatment{NewId<store::TreatmentId>(), subject->id, *date, options.text, "", {}, {}};
  const Status added = store::AddTreatment(*record, treatment, "", NewStamp());
  if (!added) return Fail(added.error(), "adding a treatment");
  run.Output({{"id", treatment.id.ToString()}}, treatment.id.ToString());
  return {};
}

Result<store::Treatment> InForce(store::Record& record, const std::string& text) {
  const auto id = FindId<store::TreatmentId>(record, text, "treatment", "see 'striae treatment list'");
  if (!id) return Fail(id.error());
  const auto treatments = store::Treatments(record);
  if (!treatments) return Fail(treatments.error());
  for (const store::Treatment& treatment : *treatments) {
    if (treatment.id == *id) return treatment;
  }
  return Fail(ErrorCode::kNotFound, "this treatment was corrected already; see 'striae treatment list'");
}

Status Correct(Context& run, const Options& options, bool strike) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto before = InForce(*record, options.target);
  if (!before) return Fail(before.error());
  store::Treatment corrected = *before;
  corrected.id = NewId<store::TreatmentId>();
  corrected.supersedes = before->id;
  if (!options.text.empty()) corrected.text = options.text;
  if (!options.date.empty()) {
    const auto date = Date::Parse(options.date);
    if (!date) return Fail(date.error(), "--date");
    corrected.date = *date;
  }
  const Status done = strike ? store::StrikeTreatment(*record, before->id, corrected.id, options.reason, NewStamp())
                             : store::AddTreatment(*record, corrected, options.reason, NewStamp());
  if (!done) return Fail(done.error(), "correcting a treatment");
  run.Output({{"id", corrected.id.ToString()}, {"supersedes", before->id.ToString()}},
             strike ? "marked as entered in error" : corrected.id.ToString());
  return {};
}

Status List(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  std::optional<SubjectId> only;
  if (!options.target.empty()) {
    const auto subject = record->SubjectByPseudonym(options.target);
    if (!subject) return Fail(subject.error());
    only = subject->id;
  }
  const auto treatments = store::Treatments(*record, only);
  if (!treatments) return Fail(treatments.error());
  nlohmann::json list = nlohmann::json::array();
  std::string text;
  for (const store::Treatment& treatment : *treatments) {
    const auto subject = record->SubjectById(treatment.subject);
    if (!subject) return Fail(subject.error());
    nlohmann::json entry = store::ToJson(treatment);
    entry["subject"] = subject->pseudonym;
    list.push_back(std::move(entry));
    text += (text.empty() ? "" : "\n") + treatment.id.ToString() + "  " + subject->pseudonym + "  " +
            treatment.date.ToString() + "  " + treatment.text;
  }
  run.Output({{"treatments", list}}, text.empty() ? "no treatments" : text);
  return {};
}

}  // namespace

void AddCommand_treatment(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "treatment", "Treatments of the subjects, with their dates");
  auto options = std::make_shared<Options>();
  CLI::App* add = AddCommand(group, context, "add", "Enter a treatment",
                             "striae -C trial treatment add S001 --date 2026-05-04 --text \"compression, 40 mmHg\"");
  add->add_option("SUBJECT", options->target, "Pseudonym")->required();
  add->add_option("--date", options->date, "Day of the treatment")->required();
  add->add_option("--text", options->text, "What was done")->required();
  OnRun(add, context, [options](Context& run) { return Add(run, *options); });
  CLI::App* correct =
      AddCommand(group, context, "correct", "Correct a treatment; the entry before stays readable",
                 "striae -C trial treatment correct 3f0c4f5e --date 2026-05-05 --reason \"typed wrong\"");
  correct->add_option("--date", options->date, "The right day");
  correct->add_option("--text", options->text, "The right text");
  CLI::App* strike = AddCommand(group, context, "strike", "Mark a treatment as entered in error",
                                "striae -C trial treatment strike 3f0c4f5e --reason \"another subject's\"");
  for (CLI::App* command : {correct, strike}) {
    command->add_option("TREATMENT", options->target, "Its id")->required();
    command->add_option("--reason", options->reason, "Why")->required();
    OnRun(command, context,
          [options, strikes = command == strike](Context& run) { return Correct(run, *options, strikes); });
  }
  CLI::App* list = AddCommand(group, context, "list", "List the treatments", "striae -C trial treatment list");
  list->add_option("SUBJECT", options->target, "Only this subject's");
  OnRun(list, context, [options](Context& run) { return List(run, *options); });
}

}  // namespace striae::app
