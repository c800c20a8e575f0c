#include "app/staging.h"

namespace striae::app {

Result<std::unique_ptr<Staging>> Staging::In(const std::filesystem::path& folder) {
  std::error_code error;
  const bool existed = std::filesystem::exists(folder, error);
  auto staging = std::make_unique<Staging>(folder, !existed);
  std::filesystem::create_directories(staging->path(), error);
  if (error) {
    return Fail(ErrorCode::kIo, "cannot write into " + folder.string() + " (" + error.message() +
                                    "); choose a folder that you may write to");
  }
  return staging;
}

Staging::Staging(std::filesystem::path folder, bool made_folder)
    : folder_(std::move(folder)), path_(folder_ / ".striae-export"), made_folder_(made_folder) {}

Staging::~Staging() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
  if (made_folder_) std::filesystem::remove(folder_, ignored);  // only if it is empty
}

Status Staging::Publish(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    std::error_code error;
    std::filesystem::rename(path_ / name, folder_ / name, error);
    if (error) {
      return Fail(ErrorCode::kIo, "cannot put " + name + " into " + folder_.string() + ": " + error.message());
    }
  }
  return {};
}

}  // namespace striae::app
