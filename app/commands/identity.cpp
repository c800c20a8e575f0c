// `striae identity`: who the subjects are, in an encrypted file of its own. No value is ever on the command line.
#include "store/identity.h"

#include <iostream>

#include <sodium.h>
#include <sys/resource.h>
#include <unistd.h>

#include "app/io/files.h"
#include "app/sign_in.h"
#include "app/study.h"

namespace striae::app {
namespace {

struct Options {
  std::string subject, from;
  std::filesystem::path passphrase_file, new_passphrase_file;
};

/// A core file would hold what this program has open.
void WriteNoCore() {
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
}

std::filesystem::path FileOf(const store::Record& record) { return record.folder() / store::kIdentityName; }

store::IdentityRandom NewRandom() {
  store::IdentityRandom random;
  randombytes_buf(random.data(), random.size());
  return random;
}

std::string Ask(const char* prompt) {
  if (::isatty(STDIN_FILENO) == 1) std::cerr << prompt << ": " << std::flush;
  std::string line;
  std::getline(std::cin, line);
  return line;
}

/// {"name", "birth_date", "hospital_id"} from --from FILE or '-' (stdin), else three lines, asked for on a terminal.
Result<nlohmann::json> ReadPerson(const std::string& from) {
  if (from.empty()) {
    nlohmann::json person;
    person["name"] = Ask("Name");
    person["birth_date"] = Ask("Birth date (YYYY-MM-DD)");
    person["hospital_id"] = Ask("Hospital number");
    return person;
  }
  std::string text;
  if (from == "-") {
    text.assign(std::istreambuf_iterator<char>(std::cin), {});
  } else {
    auto read = ReadText(from);
    if (!read) return Fail(read.error());
    text = *std::move(read);
  }
  auto person = nlohmann::json::parse(text, nullptr, false);
  // Nothing of the file is repeated in the message.
  if (!person.is_object()) return Fail(ErrorCode::kBadFile, "--from: the file is no JSON object; see --help");
  for (const auto& [key, value] : person.items()) {
    const bool known = key == "name" || key == "birth_date" || key == "hospital_id";
    if (!known || !value.is_string()) {
      return Fail(ErrorCode::kBadFile, "--from: the object has \"name\", \"birth_date\" and \"hospital_id\", all text");
    }
  }
  return person;
}

Result<store::Identity> MakeIdentity(const Subject& subject, const nlohmann::json& person) {
  const store::Stamp stamp = NewStamp();
  store::Identity identity{subject.id, subject.pseudonym, person.value("name", ""), {}, person.value("hospital_id", ""),
                           stamp.now,  stamp.user};
  if (identity.name.empty()) return Fail(ErrorCode::kUsage, "a name is needed");
  const std::string birth = person.value("birth_date", "");
  if (!birth.empty()) {
    const auto date = Date::Parse(birth);
    if (!date) return Fail(ErrorCode::kUsage, "the birth date is a day as YYYY-MM-DD, or left empty");
    identity.birth_date = *date;
  }
  return identity;
}

Status Set(Context& run, const Options& options) {
  WriteNoCore();
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto subject = record->SubjectByPseudonym(options.subject);
  if (!subject) return Fail(subject.error());
  // The first one makes the file: a slip of the finger would lock it for good.
  const auto file = PassphraseFile({"", options.passphrase_file});
  auto passphrase = std::filesystem::exists(FileOf(*record))
                        ? AskPassphrase(file, "Passphrase of identity.striae")
                        : AskNewPassphrase(file, "New passphrase of identity.striae");
  if (!passphrase) return Fail(passphrase.error());
  const auto person = ReadPerson(options.from);
  if (!person) return Fail(person.error());
  auto identity = MakeIdentity(*subject, *person);
  if (!identity) return Fail(identity.error());
  std::size_t count = 0;
  const auto put = [&](std::vector<store::Identity>& all) -> Status {
    std::erase_if(all, [&](const store::Identity& known) { return known.subject == subject->id; });
    all.push_back(*std::move(identity));
    count = all.size();
    return {};
  };
  const Status written = store::ChangeIdentities(*record, {*passphrase, {}, put, NewRandom(), {}}, NewStamp());
  sodium_memzero(passphrase->data(), passphrase->size());
  if (!written) return written;
  run.Output({{"subject", options.subject}, {"identities", count}},
             "identity of " + options.subject + " kept in " + std::string(store::kIdentityName));
  return {};
}

Status Show(Context& run, const Options& options) {
  WriteNoCore();
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto passphrase = AskPassphrase(PassphraseFile({"", options.passphrase_file}), "Passphrase of identity.striae");
  if (!passphrase) return Fail(passphrase.error());
  const auto all = store::ReadIdentities(FileOf(*record), *passphrase);
  if (!all) return Fail(all.error());
  nlohmann::json list = nlohmann::json::array();
  std::string text;
  for (const store::Identity& person : *all) {
    if (!options.subject.empty() && person.pseudonym != options.subject) continue;
    const std::string birth = person.birth_date ? person.birth_date->ToString() : "";
    list.push_back({{"subject", person.pseudonym},
                    {"name", person.name},
                    {"birth_date", birth},
                    {"hospital_id", person.hospital_id},
                    {"changed_at", person.changed_at.ToString()},
                    {"changed_by", person.changed_by}});
    text +=
        (text.empty() ? "" : "\n") + person.pseudonym + "  " + person.name + "  " + birth + "  " + person.hospital_id;
  }
  if (!options.subject.empty() && list.empty()) {
    return Fail(ErrorCode::kNotFound,
                "identity.striae does not name " + options.subject + "; see 'striae identity set'");
  }
  run.Output({{"identities", list}}, text);
  return {};
}

Status ChangePassphrase(Context& run, const Options& options) {
  WriteNoCore();
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto before = AskPassphrase(PassphraseFile({"", options.passphrase_file}), "Passphrase until now");
  if (!before) return Fail(before.error());
  // Before a new one is asked for: a wrong one is told at once.
  if (const auto all = store::ReadIdentities(FileOf(*record), *before); !all) return Fail(all.error());
  const auto after = AskNewPassphrase(options.new_passphrase_file, "New passphrase");
  if (!after) return Fail(after.error());
  if (after->empty()) return Fail(ErrorCode::kUsage, "the new passphrase is empty; nothing was changed");
  std::size_t count = 0;
  const auto keep = [&](const std::vector<store::Identity>& all) -> Status {
    count = all.size();
    return {};
  };
  const Status written = store::ChangeIdentities(*record, {*before, *after, keep, NewRandom(), {}}, NewStamp());
  if (!written) return written;
  run.Output({{"identities", count}}, "identity.striae has its new passphrase; older backups keep the old one");
  return {};
}

void AddPassphrase(CLI::App& command, Options& options) {
  command.add_option("--passphrase-file", options.passphrase_file,
                     "File whose first line is the passphrase (else STRIAE_PASSPHRASE_FILE, else the terminal asks)");
}

}  // namespace

void AddCommand_identity(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "identity", "Who the subjects are: an encrypted file of its own, not for daily work");
  auto options = std::make_shared<Options>();
  CLI::App* set =
      AddCommand(group, context, "set",
                 "Keep a subject's name, birth date and hospital number. They are asked for, one a line,\n"
                 "or read from a JSON file; they are never given on the command line.",
                 "striae -C trial identity set S001\n  striae -C trial identity set S001 --from person.json "
                 "--passphrase-file key.txt\n  (person.json: {\"name\": \"Test^Subject\", \"birth_date\": "
                 "\"1950-01-31\", \"hospital_id\": \"H-1\"})");
  set->add_option("SUBJECT", options->subject, "The pseudonym")->required();
  set->add_option("--from", options->from, "JSON file, or - for stdin")->type_name("FILE");
  AddPassphrase(*set, *options);
  OnRun(set, context, [options](Context& run) { return Set(run, *options); });

  CLI::App* show =
      AddCommand(group, context, "show", "Print one subject's identity, or all", "striae -C trial identity show S001");
  show->add_option("SUBJECT", options->subject, "The pseudonym; all when not given");
  AddPassphrase(*show, *options);
  OnRun(show, context, [options](Context& run) { return Show(run, *options); });

  CLI::App* change = AddCommand(group, context, "passphrase", "Give identity.striae a new passphrase",
                                "striae -C trial identity passphrase");
  AddPassphrase(*change, *options);
  change->add_option("--new-passphrase-file", options->new_passphrase_file, "File with the new passphrase");
  OnRun(change, context, [options](Context& run) { return ChangePassphrase(run, *options); });
}

}  // namespace striae::app
