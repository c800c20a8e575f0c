// `striae reconcile`: a card or folder held against the record. Nothing is changed on either side.
#include <map>
#include <set>

#include "acquire/folder.h"
#include "acquire/structure.h"
#include "app/names.h"
#include "app/progress.h"
#include "app/study.h"
#include "store/objects.h"

namespace striae::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Options {
  fs::path folder;
  std::string session;
};

/// What was found, as it grows.
struct Reconciled {
  json files = json::array(), missing = json::array();
  std::set<Sha256> on_card;
  std::map<SessionId, std::string> sessions;  ///< those that something on the card belongs to; the subject's pseudonym
  int imported = 0, not_imported = 0, broken = 0, lost = 0;
  std::string text;
  void Say(const std::string& line) { text += (text.empty() ? "" : "\n") + line; }
};

Result<std::string> SubjectOf(store::Record& record, const SessionId& id) {
  const auto session = record.SessionById(id);
  if (!session) return Fail(session.error());
  const auto subject = record.SubjectById(session->subject);
  if (!subject) return Fail(subject.error());
  return subject->pseudonym;
}

Status AddKnown(store::Record& record, const std::vector<Capture>& captures, const std::string& name, json entry,
                Reconciled& all) {
  const Capture& capture = captures.front();
  for (const Capture& each : captures) {
    const auto subject = SubjectOf(record, each.session);
    if (!subject) return Fail(subject.error());
    all.sessions[each.session] = *subject;
  }
  // Only whether it is there: `check` reads every object.
  const bool kept = record.objects().Has(capture.sha256);
  ++(kept ? all.imported : all.lost);
  entry["status"] = kept ? "imported" : "lost";
  entry["capture"] = capture.id.ToString();
  entry["session"] = capture.session.ToString();
  entry["subject"] = all.sessions[capture.session];
  if (!kept) all.Say(name + ": in the record, but its object is lost; import it again into the same session");
  all.files.push_back(std::move(entry));
  return {};
}

Status AddFile(store::Record& record, const fs::path& path, const Result<std::optional<acquire::IngestItem>>& item,
               Reconciled& all) {
  const std::string name = path.string();
  json entry = {{"file", name}};
  const auto broken = [&](const Error& error) -> Status {
    ++all.broken;
    entry["status"] = "broken";
    entry["message"] = error.Describe();
    all.files.push_back(entry);
    all.Say(name + ": broken: " + error.Describe());
    return {};
  };
  if (!item) return broken(item.error());
  const Sha256 sha256 = store::HashOf((*item)->bytes);
  all.on_card.insert(sha256);
  entry["sha256"] = sha256.ToString();
  const auto captures = record.CapturesOf(sha256);
  if (!captures) return Fail(captures.error());
  if (!captures->empty()) return AddKnown(record, *captures, name, entry, all);
  if (const auto structure = acquire::CheckStructure((*item)->bytes); !structure) return broken(structure.error());
  ++all.not_imported;
  entry["status"] = "not-imported";
  all.files.push_back(entry);
  all.Say(name + ": not imported");
  return {};
}

/// Photographs of the sessions at hand that the card does not have.
Status AddMissing(store::Record& record, Reconciled& all) {
  for (const auto& [session, subject] : all.sessions) {
    const auto captures = record.Captures(session);
    if (!captures) return Fail(captures.error());
    for (const Capture& capture : *captures) {
      if (all.on_card.contains(capture.sha256)) continue;
      all.missing.push_back({{"capture", capture.id.ToString()},
                             {"file_name", capture.file_name},
                             {"sha256", capture.sha256.ToString()},
                             {"session", session.ToString()},
                             {"subject", subject}});
      all.Say(capture.file_name + " of " + subject + ", session " + session.ToString() +
              ": in the record, not in this folder");
    }
  }
  return {};
}

Status Reconcile(Context& run, const Options& options) {
  if (options.folder.empty()) {
    return Fail(
        ErrorCode::kUsage,
        "name the card's folder: put the camera's card into a reader, then 'striae reconcile /media/NIKON_D90'; "
        "the card of a camera on the cable is not listed, because the camera then takes no photographs");
  }
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  Reconciled all;
  if (!options.session.empty()) {
    const auto session = FindSession(*record, options.session);
    if (!session) return Fail(session.error());
    const auto subject = SubjectOf(*record, session->id);
    if (!subject) return Fail(subject.error());
    all.sessions[session->id] = *subject;
  }
  const auto listing = acquire::ListFolder(options.folder);
  if (!listing) return Fail(listing.error());
  acquire::FolderSource source(listing->files, {});
  ProgressBar bar;
  for (const fs::path& path : listing->files) {
    bar.Show(all.files.size(), listing->files.size(), path.filename().string());
    if (auto added = AddFile(*record, path, source.Next(), all); !added) return added;
  }
  bar.Clear();
  if (auto added = AddMissing(*record, all); !added) return added;
  all.Say(std::to_string(all.imported) + " imported, " + std::to_string(all.not_imported) + " not imported, " +
          std::to_string(all.broken) + " broken, " + std::to_string(all.lost) + " lost in the record, " +
          std::to_string(all.missing.size()) + " in the record but not here");
  run.Output({{"folder", options.folder.string()},
              {"files", all.files},
              {"missing", all.missing},
              {"imported", all.imported},
              {"not_imported", all.not_imported},
              {"broken", all.broken},
              {"lost", all.lost}},
             all.text);
  return {};
}

}  // namespace

void AddCommand_reconcile(CLI::App& root, Context& context) {
  CLI::App* command = AddCommand(
      root, context, "reconcile",
      "Hold a card or folder against the record: which photographs are not imported yet, and which ones of the same\n"
      "sessions the record has and the card has not. By content (SHA-256), whatever the files are called. Nothing is\n"
      "changed; exit code 0 also when something differs.",
      "striae -C trial reconcile /media/NIKON_D90");
  auto options = std::make_shared<Options>();
  command->add_option("DIR", options->folder, "The card's folder; folders below it count as well");
  command->add_option("--session", options->session, "Also name the photographs of this session that are not there");
  OnRun(command, context, [options](Context& run) { return Reconcile(run, *options); });
}

}  // namespace striae::app
