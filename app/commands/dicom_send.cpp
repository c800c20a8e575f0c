// `striae dicom send` and `striae dicom echo`: to a PACS.
#include <algorithm>

#include "app/dicom_session.h"
#include "app/study.h"
#include "dicom/network.h"

namespace striae::app {
namespace {

struct Options {
  std::string session;
  std::filesystem::path folder;
  bool strip = false;
  dicom::Peer peer;
};

/// A folder that is gone when the command ends.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_(std::filesystem::temp_directory_path() / ("striae-send-" + NewUuid().ToString())) {}
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

Result<std::vector<std::filesystem::path>> FilesIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->is_regular_file(error) && it->path().extension() == ".dcm") files.push_back(it->path());
  }
  if (error) return Fail(ErrorCode::kNotFound, "cannot read folder " + folder.string() + ": " + error.message());
  if (files.empty()) return Fail(ErrorCode::kNotFound, "there are no .dcm files in " + folder.string());
  std::sort(files.begin(), files.end());
  return files;
}

Result<std::vector<std::filesystem::path>> FilesOfSession(Context& context, const Options& options,
                                                          const std::filesystem::path& folder) {
  const auto session = ParseSessionId(options.session);
  if (!session) return Fail(session.error());
  auto record = OpenStudy(context);
  if (!record) return Fail(record.error());
  const auto exported = ExportSession(*record, *session, options.strip, folder);
  if (!exported) return Fail(exported.error(), "DICOM export of session " + options.session);
  for (const LeftOut& left_out : exported->left_out) context.Note(left_out.file_name + ": " + left_out.reason);
  std::vector<std::filesystem::path> files;
  for (const ExportedObject& object : exported->objects) files.push_back(folder / object.file_name);
  return files;
}

nlohmann::json ToJson(const dicom::Peer& peer) {
  return {{"host", peer.host}, {"port", peer.port}, {"called_aet", peer.called_aet}, {"calling_aet", peer.calling_aet}};
}

Status Report(Context& context, const Options& options, const dicom::SendReport& report) {
  nlohmann::json document = ToJson(options.peer);
  document["objects"] = nlohmann::json::array();
  std::string text;
  std::size_t stored = 0;
  for (const dicom::SendOutcome& outcome : report.outcomes) {
    stored += outcome.stored ? 1 : 0;
    document["objects"].push_back({{"file", outcome.file.filename().string()},
                                   {"sop_class_uid", outcome.sop_class_uid},
                                   {"sop_instance_uid", outcome.sop_instance_uid},
                                   {"stored", outcome.stored},
                                   {"status", outcome.status},
                                   {"worth_retrying", outcome.worth_retrying},
                                   {"message", outcome.message}});
    text += outcome.file.filename().string() + (outcome.stored ? ": stored" : ": not stored") +
            (outcome.message.empty() ? "" : ", " + outcome.message) + "\n";
  }
  document["stored"] = stored;
  document["failed"] = report.outcomes.size() - stored;
  text += std::to_string(stored) + " of " + std::to_string(report.outcomes.size()) + " stored";
  context.Output(document, text);
  if (report.AllStored()) return {};
  return Fail(ErrorCode::kNetworkFailed, std::to_string(report.outcomes.size() - stored) +
                                             " objects were not stored; the reasons are above. What was stored may be "
                                             "sent again without harm");
}

Status Send(Context& context, const Options& options) {
  if (options.session.empty() == options.folder.empty()) {
    return Fail(ErrorCode::kUsage, "say what to send: either --session ID or a folder with .dcm files");
  }
  const TemporaryFolder temporary;
  const auto files =
      options.session.empty() ? FilesIn(options.folder) : FilesOfSession(context, options, temporary.path());
  if (!files) return Fail(files.error());
  const auto report = dicom::Send(*files, options.peer);
  if (!report) return Fail(report.error());
  return Report(context, options, *report);
}

Status Echo(Context& context, const Options& options) {
  if (auto answer = dicom::Echo(options.peer); !answer) return answer;
  nlohmann::json document = ToJson(options.peer);
  document["answered"] = true;
  context.Output(document, options.peer.called_aet + " answers");
  return {};
}

void AddPeer(CLI::App* command, const std::shared_ptr<Options>& options) {
  command->add_option("--host", options->peer.host, "The PACS's name or address")->required();
  command->add_option("--port", options->peer.port, "Its port")->required();
  command->add_option("--aec", options->peer.called_aet, "AE title of the PACS")->capture_default_str();
  command->add_option("--aet", options->peer.calling_aet, "Our own AE title")->capture_default_str();
  command->add_option("--timeout", options->peer.timeout_s, "Seconds to wait for a connection or an answer")
      ->capture_default_str();
}

}  // namespace

void AddCommand_dicom_send(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "dicom", "DICOM objects of a session, and the way to a PACS");
  auto options = std::make_shared<Options>();
  CLI::App* send = AddCommand(
      group, context, "send",
      "Send a session, or DICOM files exported before, to a PACS. Each object's outcome is told; the exit code is 1 "
      "when\n"
      "one was not stored.",
      "striae -C trial dicom send --session 3f0c2f6e-8f4f-4c1e-9d39-5d2f3f1f9a11 --host pacs --port 104 --aec PACS");
  send->add_option("--session", options->session, "The session's id (striae session list)");
  send->add_option("folder", options->folder, "Or a folder with .dcm files")->type_name("FOLDER");
  send->add_flag("--strip-metadata", options->strip, "As in `dicom export`; only with --session");
  AddPeer(send, options);
  OnRun(send, context, [options](Context& run) { return Send(run, *options); });

  CLI::App* echo = AddCommand(group, context, "echo", "Ask a PACS whether it is there (C-ECHO)",
                              "striae dicom echo --host pacs --port 104 --aec PACS");
  AddPeer(echo, options);
  OnRun(echo, context, [options](Context& run) { return Echo(run, *options); });
}

}  // namespace striae::app
