#include "app/io/ply_file.h"

#include <system_error>

#include "app/io/files.h"

namespace striae::app {

namespace fs = std::filesystem;

Status CheckWritable(const fs::path& path) {
  std::error_code code;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, code)) {
    return Fail(ErrorCode::kIo, folder.string() + " is no folder to write into; check the folder and its name");
  }
  if (fs::is_directory(path, code)) {
    return Fail(ErrorCode::kIo, path.string() + " is a folder; give the name of a file");
  }
  return {};
}

Status WritePly(const std::function<bool(const PieceSink&)>& encode, const fs::path& path, std::size_t expected) {
  return WriteFile(path, encode, Kept::kSystem, expected);
}

}  // namespace striae::app
