// Files kept by content: objects/ab/cdef... named by their SHA-256, read-only, never overwritten.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/hex.h"
#include "core/result.h"

namespace striae::store {

namespace detail {
class FolderLock;
}

/// SHA-256 (FIPS 180-4) of bytes.
Sha256 HashOf(std::span<const std::uint8_t> bytes);

class ObjectStore {
 public:
  /// `folder` is the study's objects/ folder; made when absent.
  static Result<ObjectStore> Open(const std::filesystem::path& folder);

  /// Keeps the bytes and returns their name. Temporary file, fsync, link without overwriting, fsync of the folder: a
  /// kill at any instant leaves the object whole or absent. The same bytes again change nothing. kIo when the disk is
  /// full or read-only; kRecordDamaged when the object is there already with altered content.
  [[nodiscard]] Result<Sha256> Put(std::span<const std::uint8_t> bytes) const;
  /// The same for bytes that the caller has hashed: a photograph is hashed once.
  [[nodiscard]] Result<Sha256> Put(std::span<const std::uint8_t> bytes, const Sha256& sha256) const;

  /// Keeps the content of a file, read block by block, under the name that it must have: kRecordDamaged, and nothing is
  /// kept, when the bytes are others.
  [[nodiscard]] Status PutFile(const std::filesystem::path& file, const Sha256& expected) const;

  /// The bytes, hashed again while read: kNotFound when absent, kRecordDamaged when not what they were.
  [[nodiscard]] Result<std::vector<std::uint8_t>> Get(const Sha256& sha256) const;

  /// Hashes the object without holding it in memory: kNotFound, kRecordDamaged, or fine.
  [[nodiscard]] Status Verify(const Sha256& sha256) const;
  /// The same, and says whether it was cut or altered.
  [[nodiscard]] Status Verify(const Sha256& sha256, std::uint64_t size_bytes) const;

  /// True if a file of that name is there (its content is not looked at).
  [[nodiscard]] bool Has(const Sha256& sha256) const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// The whole folder for one program (repair): kIo while another program has the study open.
  [[nodiscard]] Status TakeAlone() const;
  void Share() const;
  /// Where the object is or would be. For reading only.
  [[nodiscard]] std::filesystem::path PathOf(const Sha256& sha256) const;

  /// What lies in the folder: objects by name, and files that are not objects (left by a kill, or put there by hand).
  struct Listing {
    std::vector<Sha256> objects;
    std::vector<std::filesystem::path> strangers;
  };
  [[nodiscard]] Result<Listing> List() const;
  /// The part of the listing whose names begin with this byte; what is no object of any part comes with part 0.
  /// A large study is gone through in 256 parts, without all its names in memory.
  [[nodiscard]] Result<Listing> ListPart(std::uint8_t first_byte) const;

 private:
  explicit ObjectStore(std::filesystem::path folder);
  std::filesystem::path folder_;
  std::shared_ptr<detail::FolderLock> lock_;  ///< shared with other programs as long as the study is open
};

}  // namespace striae::store
