// Photographs from plain files: single ones, a folder, or a card with its DCIM tree.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "acquire/source.h"

namespace striae::acquire {

/// A file stands for itself, whatever its name; a folder for all JPEG and NEF files in it and below (*.jpg, *.jpeg,
/// *.nef in any case), without names that begin with a dot or are still being written (*.part). Sorted by path, each
/// file once. Symbolic links to folders are not followed. kNotFound when a path does not exist or when a folder holds
/// no photograph at all.
Result<std::vector<std::filesystem::path>> ListPhotographs(const std::vector<std::filesystem::path>& paths);

/// A folder as it is now: its photographs (as above; none is no error), and itself with the folders below.
struct FolderListing {
  std::vector<std::filesystem::path> files, folders;
};
Result<FolderListing> ListFolder(const std::filesystem::path& folder);

/// Reads each file in turn; the files themselves are only read, never moved, renamed or deleted.
class FolderSource : public CaptureSource {
 public:
  FolderSource(std::vector<std::filesystem::path> files, CaptureBinding binding);
  /// An unreadable file is an error (kIo) and the next call goes on with the one after it.
  Result<std::optional<IngestItem>> Next() override;

 private:
  std::vector<std::filesystem::path> files_;
  CaptureBinding binding_;
  std::size_t next_ = 0;
};

}  // namespace striae::acquire
