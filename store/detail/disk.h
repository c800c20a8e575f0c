// Files on the disk, down to their fsync. Throws Failed (kIo) with the path and what to check.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include <unistd.h>

#include "core/hex.h"

namespace striae::store::detail {

/// Closes on the way out.
class File {
 public:
  explicit File(int descriptor) : descriptor_(descriptor) {}
  ~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  [[nodiscard]] int get() const { return descriptor_; }

 private:
  int descriptor_;
};

/// `what` reads "read", "write", ...; `reason` is an errno.
[[noreturn]] void RefuseIo(const char* what, const std::filesystem::path& path, int reason);
/// What was linked or made in the folder is on the disk when this returns.
void SyncFolder(const std::filesystem::path& folder);
/// Makes the folder (its parent exists) and syncs the parent; nothing when it is there.
void MakeFolder(const std::filesystem::path& folder);
/// All bytes, read-only mode, fsync.
void WriteWhole(int file, const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
/// Gives the finished file its name unless one is there. False when there is one.
bool Publish(const std::filesystem::path& temporary, const std::filesystem::path& target);
/// The whole file; shorter than its size when it is cut meanwhile.
std::vector<std::uint8_t> ReadWhole(const std::filesystem::path& path);
/// SHA-256 without holding the file in memory.
Sha256 HashFile(const std::filesystem::path& path);

}  // namespace striae::store::detail
