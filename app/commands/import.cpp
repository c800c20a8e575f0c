// `striae import`: photographs from files, a folder or a card into a session.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "acquire/folder.h"
#include "app/command.h"
#include "app/intake.h"
#include "app/study.h"

namespace striae::app {
namespace {

struct Options {
  std::string session, role = "unassigned", body_site, laterality, range;
  std::vector<std::filesystem::path> paths;
};

/// What was typed for an option cannot be meant: exit code 2.
tl::unexpected<Error> Usage(const Error& error, const char* option) {
  return Fail(ErrorCode::kUsage, std::string(option) + ": " + error.message);
}

Status Import(Context& context, const Options& options) {
  const auto role = CaptureRole::Parse(options.role);
  if (!role) return Usage(role.error(), "--as");
  const auto laterality = ParseLaterality(options.laterality);
  if (!laterality) return Usage(laterality.error(), "--laterality");
  std::optional<RigRange> range;
  if (!options.range.empty()) {
    const auto parsed = ParseRigRange(options.range);
    if (!parsed) return Usage(parsed.error(), "--range");
    range = *parsed;
  }
  const auto session = ParseSessionId(options.session);
  if (!session) return Fail(session.error());
  auto record = OpenStudy(context);
  if (!record) return Fail(record.error());
  auto binding = BindTo(*record, *session);
  if (!binding) return Fail(binding.error());
  binding->role = *role;
  binding->body_site = options.body_site;
  binding->laterality = *laterality;
  auto files = acquire::ListPhotographs(options.paths);
  if (!files) return Fail(files.error());

  acquire::FolderSource source(*files, *binding);
  std::vector<Intake> intakes;
  for (const auto& file : *files) {
    const auto item = source.Next();
    if (item) {
      intakes.push_back(TakeIn(*record, **item, range, Refused::kLeaveAtSource));
    } else {
      Intake unreadable;
      unreadable.origin = file.string();
      unreadable.error = item.error();
      intakes.push_back(std::move(unreadable));
    }
    context.Note(Describe(intakes.back()));
  }
  const auto document = ToJson(*session, intakes);
  context.Output(document, std::to_string(document["added"].get<int>()) + " added, " +
                               std::to_string(document["already_there"].get<int>()) + " already there, " +
                               std::to_string(document["failed"].get<int>()) + " failed");
  return OutcomeOf(intakes);
}

}  // namespace

void AddCommand_import(CLI::App& root, Context& context) {
  CLI::App* command = AddCommand(
      root, context, "import",
      "Bring photographs into a session: files, a folder, or a card. Files are read, never changed; one that is not\n"
      "whole is kept in the study's quarantine folder with the reason, and the exit code is 1.",
      "striae -C trial import --session 3f0c2f6e-8f4f-4c1e-9d39-5d2f3f1f9a11 DSC_0042.JPG --as wound:W1 --site calf "
      "--laterality L");
  auto options = std::make_shared<Options>();
  command->add_option("--session", options->session, "The session's id (striae session list)")->required();
  command->add_option("paths", options->paths, "JPEG or NEF files, or folders with them")
      ->required()
      ->type_name("FILE|DIR");
  command->add_option("--as", options->role, "What they show: wound:LABEL, neutral, pose or unassigned")
      ->type_name("ROLE")
      ->capture_default_str();
  command->add_option("--site", options->body_site, "Part of the body, e.g. calf")->type_name("TEXT");
  command->add_option("--laterality", options->laterality, "L, R, B (both) or U (unpaired)")->type_name("SIDE");
  command
      ->add_option("--range", options->range,
                   "Judge the settings for this rig, small (1 m) or large (2 m); otherwise the device's own")
      ->type_name("RANGE");
  OnRun(command, context, [options](Context& run) { return Import(run, *options); });
}

}  // namespace striae::app
