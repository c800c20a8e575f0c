// `striae merge`: what another copy of the study has, taken into this one.
#include "store/merge.h"

#include <cstdlib>

#include "app/progress.h"
#include "app/study.h"

namespace striae::app {
namespace {

/// A folder for what is needed during one command.
class Scratch {
 public:
  Scratch() {
    std::error_code code;
    std::string name = (std::filesystem::temp_directory_path(code) / "striae-merge-XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

Status Merge(Context& run, const std::filesystem::path& folder) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const Scratch scratch;
  if (scratch.path().empty()) return Fail(ErrorCode::kIo, "no temporary folder can be made; check TMPDIR and the disk");
  auto other = store::OpenOther(folder, scratch.path(), NewStamp());
  if (!other) return Fail(other.error(), folder.string());
  ProgressBar bar;
  const auto report = store::Merge(*record, *other, bar.AsProgress(), NewStamp());
  bar.Clear();
  if (!report) return Fail(report.error(), "merge");
  std::string text = std::to_string(report->rows) + " entries, " + std::to_string(report->updated) + " changes, " +
                     std::to_string(report->objects) + " files and " + std::to_string(report->audit_rows) +
                     " audit rows taken from " + folder.string();
  if (report->audit_rows == 0) text = "nothing new in " + folder.string();
  for (const std::string& query : report->queries) text += "\nquery: " + query;
  run.Output({{"rows", report->rows},
              {"updated", report->updated},
              {"objects", report->objects},
              {"audit_rows", report->audit_rows},
              {"queries", report->queries}},
             text);
  return {};
}

}  // namespace

void AddCommand_merge(CLI::App& root, Context& context) {
  CLI::App* command =
      AddCommand(root, context, "merge",
                 "Take everything that another copy of this study has into this one; the other copy is only read. "
                 "Merge the other\n"
                 "way as well and both are equal; again adds nothing. What two people must settle becomes a query.",
                 "striae -C trial merge laptop/trial && striae -C laptop/trial merge trial");
  auto folder = std::make_shared<std::filesystem::path>();
  command->add_option("OTHER", *folder, "The other copy's folder, made with 'striae restore --branch'")->required();
  OnRun(command, context, [folder](Context& run) { return Merge(run, *folder); });
}

}  // namespace striae::app
