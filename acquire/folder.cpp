#include "acquire/folder.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

namespace striae::acquire {
namespace {

namespace fs = std::filesystem;

bool IsPhotographName(const std::string& name) {
  if (name.empty() || name[0] == '.') return false;
  std::string lower = name;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  for (const char* ending : {".jpg", ".jpeg", ".nef"}) {
    if (lower.ends_with(ending)) return true;
  }
  return false;
}

Status AddFolder(const fs::path& folder, std::vector<fs::path>& files) {
  auto listing = ListFolder(folder);
  if (!listing) return Fail(listing.error());
  if (listing->files.empty()) {
    return Fail(ErrorCode::kNotFound, folder.string() + " holds no JPEG or NEF file; check the folder");
  }
  files.insert(files.end(), listing->files.begin(), listing->files.end());
  return {};
}

}  // namespace

Result<FolderListing> ListFolder(const fs::path& folder) {
  FolderListing listing;
  listing.folders.push_back(folder);
  std::error_code code;
  fs::recursive_directory_iterator entry(folder, code), end;
  for (; !code && entry != end; entry.increment(code)) {
    const std::string name = entry->path().filename().string();
    std::error_code unreadable;
    if (entry->is_directory(unreadable)) {
      if (name[0] == '.') {
        entry.disable_recursion_pending();  // .Trashes and the like
      } else if (!entry->is_symlink(unreadable)) {
        listing.folders.push_back(entry->path());
      }
    } else if (IsPhotographName(name) && entry->is_regular_file(unreadable)) {
      listing.files.push_back(entry->path());
    }
  }
  if (code) {
    return Fail(
        code == std::errc::no_such_file_or_directory ? ErrorCode::kNotFound : ErrorCode::kIo,
        "cannot list " + folder.string() + " (" + code.message() + "); check that it is there and its permissions");
  }
  std::sort(listing.files.begin(), listing.files.end());
  return listing;
}

Result<std::vector<fs::path>> ListPhotographs(const std::vector<fs::path>& paths) {
  std::vector<fs::path> files;
  for (const auto& path : paths) {
    std::error_code code;
    if (fs::is_directory(path, code)) {
      if (auto added = AddFolder(path, files); !added) return Fail(added.error());
    } else if (fs::exists(path, code)) {
      files.push_back(path);
    } else {
      return Fail(ErrorCode::kNotFound, path.string() + " does not exist; check the name and the folder");
    }
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

FolderSource::FolderSource(std::vector<fs::path> files, CaptureBinding binding)
    : files_(std::move(files)), binding_(std::move(binding)) {}

Result<std::optional<IngestItem>> FolderSource::Next() {
  if (next_ >= files_.size()) return std::optional<IngestItem>();
  const fs::path& path = files_[next_++];
  std::ifstream stream(path, std::ios::binary);
  IngestItem item;
  item.bytes.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  if (!stream.is_open() || stream.bad()) {
    return Fail(ErrorCode::kIo, path.string() + " cannot be read; check the card and the permissions");
  }
  item.file_name = path.filename().string();
  item.origin = path.string();
  item.binding = binding_;
  return std::optional(std::move(item));
}

}  // namespace striae::acquire
