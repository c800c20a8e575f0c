// `striae import`: photographs from files, a folder or a card into a session.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "acquire/folder.h"
#include "app/command.h"
#include "app/intake.h"
#include "app/progress.h"
#include "app/tagging.h"

namespace striae::app {
namespace {

struct Options {
  TagOptions tag;
  std::vector<std::filesystem::path> paths;
  bool sidecar = false;
};

Status Import(Context& context, const Options& options) {
  auto tagged = Tag(context, options.tag);
  if (!tagged) return Fail(tagged.error());
  auto& [record, binding, range] = *tagged;
  auto files = acquire::ListPhotographs(options.paths);
  if (!files) return Fail(files.error());

  acquire::FolderSource source(*files, binding);
  std::vector<Intake> intakes;
  ProgressBar bar;
  for (const auto& file : *files) {
    bar.Show(intakes.size(), files->size(), file.filename().string());
    const auto item = source.Next();
    if (item) {
      intakes.push_back(TakeIn(record, **item, range, Refused::kLeaveAtSource));
    } else {
      Intake unreadable;
      unreadable.origin = file.string();
      unreadable.error = item.error();
      intakes.push_back(std::move(unreadable));
    }
    if (options.sidecar) AddSidecar(record, file, intakes.back());
    bar.Clear();
    context.Note(Describe(intakes.back()));
  }
  const auto document = ToJson(binding.session, intakes);
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
  AddTagOptions(*command, options->tag);
  command->add_option("paths", options->paths, "JPEG or NEF files, or folders with them")
      ->required()
      ->type_name("FILE|DIR");
  command->add_flag("--sidecar", options->sidecar,
                    "Write FILE.xmp beside each photograph: pseudonym, session and ids; the photograph stays as it is");
  OnRun(command, context, [options](Context& run) { return Import(run, *options); });
}

}  // namespace striae::app
