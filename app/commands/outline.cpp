// `striae outline`: the boundary of a wound, drawn on its photograph.
#include "app/io/files.h"
#include "app/study.h"
#include "store/json.h"

namespace striae::app {
namespace {

struct Options {
  std::string capture;
  std::filesystem::path file;
};

Status Add(Context& run, const Options& options) {
  const auto text = ReadText(options.file);
  if (!text) return Fail(text.error());
  const auto outline = OutlineFromJson(*text);
  if (!outline) return Fail(outline.error(), "reading outline " + options.file.string());
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto capture = FindCapture(*record, options.capture);
  if (!capture) return Fail(capture.error());
  if (capture->role.kind != CaptureRole::Kind::kWound) {
    run.Note("note: this capture is " + capture->role.ToString() + "; an outline is used for a wound only");
  }
  const auto added = record->AddOutline(NewId<OutlineId>(), capture->id, *outline, NewStamp());
  if (!added) return Fail(added.error(), "adding outline " + options.file.string());
  run.Output(store::ToJson(*added),
             "outline with " + std::to_string(added->outline.polygon_px.size()) + " points on " + capture->file_name);
  return {};
}

}  // namespace

void AddCommand_outline(CLI::App& root, Context& context) {
  CLI::App* command = AddCommand(root, context, "outline", "Add a wound's outline to a capture; the newest counts",
                                 "striae -C trial outline 5b1f0c9a outline.json");
  auto options = std::make_shared<Options>();
  command->add_option("CAPTURE", options->capture, "The capture's id, or its first eight or more characters")
      ->required();
  command->add_option("FILE", options->file, "Outline: {\"polygon_px\": [[col,row],...]}, or a LabelMe file")
      ->required();
  OnRun(command, context, [options](Context& run) { return Add(run, *options); });
}

}  // namespace striae::app
