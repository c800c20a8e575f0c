// `striae dicom export`: a session as DICOM files, one an object.
#include "app/dicom_session.h"
#include "app/study.h"

namespace striae::app {
namespace {

struct Options {
  std::string session;
  std::filesystem::path folder;
  bool strip = false;
};

Status Export(Context& context, const Options& options) {
  const auto session = ParseSessionId(options.session);
  if (!session) return Fail(session.error());
  auto record = OpenStudy(context);
  if (!record) return Fail(record.error());
  const auto exported = ExportSession(*record, *session, options.strip, options.folder);
  if (!exported) return Fail(exported.error(), "DICOM export of session " + options.session);
  std::string text;
  for (const ExportedObject& object : exported->objects) {
    text += (text.empty() ? "" : "\n") + (options.folder / object.file_name).string();
  }
  for (const LeftOut& left_out : exported->left_out) context.Note(left_out.file_name + ": " + left_out.reason);
  context.Output(ToJson(*exported, *session, options.folder), text);
  return {};
}

}  // namespace

void AddCommand_dicom_export(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "dicom", "DICOM objects of a session, and the way to a PACS");
  CLI::App* command = AddCommand(
      group, context, "export",
      "Write photographs, surfaces and measurements of a session as DICOM files. The same record gives the same files\n"
      "with the same UIDs. Identity is the pseudonym only.",
      "striae -C trial dicom export --session 3f0c2f6e-8f4f-4c1e-9d39-5d2f3f1f9a11 --out dicom");
  auto options = std::make_shared<Options>();
  command->add_option("--session", options->session, "The session's id (striae session list)")->required();
  command->add_option("--out", options->folder, "Folder for the files; made when absent")->required()->type_name("DIR");
  command->add_flag("--strip-metadata", options->strip,
                    "Leave out what the camera wrote into the JPEG besides the picture (decoded pixels stay the same)\n"
                    "and claim the DICOM confidentiality profile; without it the camera's bytes are kept unchanged");
  OnRun(command, context, [options](Context& run) { return Export(run, *options); });
}

}  // namespace striae::app
