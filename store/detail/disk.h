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

/// Who works with a folder: any number of programs share it, and one that rearranges it (repair) has it alone. The lock
/// goes with the program, however that ends. File systems without locks count as shared.
class FolderLock {
 public:
  /// Waits up to ten seconds for a repair to end; throws Failed (kIo) after that.
  explicit FolderLock(const std::filesystem::path& folder);
  /// False when another program works with the folder, or when that cannot be known.
  [[nodiscard]] bool TakeAlone() const;
  void Share() const;

 private:
  File folder_;
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
/// A new file of that name, whole or absent; kRecordRefused when there is one.
void WriteNew(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
/// Copies a file to a new name, whole or absent, without holding it in memory. Returns the SHA-256 of what was written.
/// `expected`: kRecordDamaged, and nothing is left, when the bytes are not those.
Sha256 CopyNew(const std::filesystem::path& from, const std::filesystem::path& to, const Sha256* expected = nullptr);
/// Gives a file another name in the same file system, never over one that is there. False when there is one.
bool MoveNew(const std::filesystem::path& from, const std::filesystem::path& to);
/// The whole file; shorter than its size when it is cut meanwhile.
std::vector<std::uint8_t> ReadWhole(const std::filesystem::path& path);
/// SHA-256 without holding the file in memory.
Sha256 HashFile(const std::filesystem::path& path);

}  // namespace striae::store::detail
