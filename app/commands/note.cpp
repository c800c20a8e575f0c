// `striae note add|correct|strike|list`: notes and deviations about anything in the record.
#include "app/local_time.h"
#include "app/names.h"
#include "app/study.h"
#include "store/annotations.h"
#include "store/json.h"

namespace striae::app {
namespace {

struct Options {
  std::string target, date, text, reason;
  bool deviation = false;
};

Status Add(Context& run, const Options& options) {
  const store::Stamp stamp = NewStamp();
  const auto date = options.date.empty() ? Result<Date>(DayAt(stamp.now, stamp.zone)) : Date::Parse(options.date);
  if (!date) return Fail(date.error(), "--date");
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto target = FindTarget(*record, options.target);
  if (!target) return Fail(target.error());
  const store::StudyNote note{NewId<store::NoteId>(), *target, options.deviation, *date, options.text, "", {}, {}};
  if (const Status added = store::AddNote(*record, note, "", stamp); !added)
    return Fail(added.error(), "adding a note");
  run.Output({{"id", note.id.ToString()}}, note.id.ToString());
  return {};
}

Result<store::StudyNote> InForce(store::Record& record, const std::string& text) {
  const auto id = FindId<store::NoteId>(record, text, "note", "see 'striae note list'");
  if (!id) return Fail(id.error());
  const auto notes = store::Notes(record);
  if (!notes) return Fail(notes.error());
  for (const store::StudyNote& note : *notes) {
    if (note.id == *id) return note;
  }
  return Fail(ErrorCode::kNotFound, "this note was corrected already; see 'striae note list'");
}

Status Correct(Context& run, const Options& options, bool strike) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto before = InForce(*record, options.target);
  if (!before) return Fail(before.error());
  store::StudyNote corrected = *before;
  corrected.id = NewId<store::NoteId>();
  corrected.supersedes = before->id;
  if (!options.text.empty()) corrected.text = options.text;
  const Status done = strike ? store::StrikeNote(*record, before->id, corrected.id, options.reason, NewStamp())
                             : store::AddNote(*record, corrected, options.reason, NewStamp());
  if (!done) return Fail(done.error(), "correcting a note");
  run.Output({{"id", corrected.id.ToString()}, {"supersedes", before->id.ToString()}},
             strike ? "marked as entered in error" : corrected.id.ToString());
  return {};
}

Status List(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  std::optional<std::string> about;
  if (!options.target.empty()) {
    const auto target = FindTarget(*record, options.target);
    if (!target) return Fail(target.error());
    about = target->id;
  }
  const auto notes = store::Notes(*record, about);
  if (!notes) return Fail(notes.error());
  nlohmann::json list = nlohmann::json::array();
  std::string text;
  for (const store::StudyNote& note : *notes) {
    list.push_back(store::ToJson(note));
    const auto name = NameOf(*record, note.about);
    if (!name) return Fail(name.error());
    text += (text.empty() ? "" : "\n") + note.id.ToString() + "  " + note.date.ToString() + "  " +
            (note.deviation ? "deviation  " : "") + *name + "  " + note.text;
  }
  run.Output({{"notes", list}}, text.empty() ? "no notes" : text);
  return {};
}

}  // namespace

void AddCommand_note(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "note", "Notes and deviations about anything in the record");
  auto options = std::make_shared<Options>();
  CLI::App* add = AddCommand(group, context, "add", "Write a note",
                             "striae -C trial note add S001 --text \"came without the bandage\"");
  add->add_option("TARGET", options->target, "A pseudonym, an id, or the word study")->required();
  add->add_option("--text", options->text, "The note")->required();
  add->add_option("--date", options->date, "The day that it is about (default: today)");
  add->add_flag("--deviation", options->deviation, "A deviation from the protocol");
  OnRun(add, context, [options](Context& run) { return Add(run, *options); });
  CLI::App* correct = AddCommand(group, context, "correct", "Correct a note; the one before stays readable",
                                 "striae -C trial note correct 3f0c4f5e --text \"...\" --reason \"typed wrong\"");
  correct->add_option("--text", options->text, "The right text")->required();
  CLI::App* strike = AddCommand(group, context, "strike", "Mark a note as entered in error",
                                "striae -C trial note strike 3f0c4f5e --reason \"another subject's\"");
  for (CLI::App* command : {correct, strike}) {
    command->add_option("NOTE", options->target, "Its id")->required();
    command->add_option("--reason", options->reason, "Why")->required();
    OnRun(command, context,
          [options, strikes = command == strike](Context& run) { return Correct(run, *options, strikes); });
  }
  CLI::App* list = AddCommand(group, context, "list", "List the notes", "striae -C trial note list");
  list->add_option("TARGET", options->target, "Only those about this");
  OnRun(list, context, [options](Context& run) { return List(run, *options); });
}

}  // namespace striae::app
