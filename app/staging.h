// Files that come into a folder together or not at all.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/result.h"

namespace striae::app {

/// A folder for the files until all are there; what is left of it goes when this ends, however it ends.
class Staging {
 public:
  /// Below `folder`, which is made when it is not there; kIo where it cannot be written.
  static Result<std::unique_ptr<Staging>> In(const std::filesystem::path& folder);
  Staging(std::filesystem::path folder, bool made_folder);
  ~Staging();
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// The files of these names get their places in the folder.
  Status Publish(const std::vector<std::string>& names);

 private:
  std::filesystem::path folder_, path_;
  bool made_folder_;
};

}  // namespace striae::app
