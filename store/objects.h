// Files kept by content: objects/ab/cdef... named by their SHA-256, read-only, never overwritten.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/hex.h"
#include "core/result.h"

namespace striae::store {

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

  /// The bytes, hashed again while read: kNotFound when absent, kRecordDamaged when not what they were.
  [[nodiscard]] Result<std::vector<std::uint8_t>> Get(const Sha256& sha256) const;

  /// Hashes the object without holding it in memory: kNotFound, kRecordDamaged, or fine.
  [[nodiscard]] Status Verify(const Sha256& sha256) const;

  /// True if a file of that name is there (its content is not looked at).
  [[nodiscard]] bool Has(const Sha256& sha256) const;
  /// Where the object is or would be. For reading only.
  [[nodiscard]] std::filesystem::path PathOf(const Sha256& sha256) const;

  /// What lies in the folder: objects by name, and files that are not objects (left by a kill, or put there by hand).
  struct Listing {
    std::vector<Sha256> objects;
    std::vector<std::filesystem::path> strangers;
  };
  [[nodiscard]] Result<Listing> List() const;

 private:
  explicit ObjectStore(std::filesystem::path folder) : folder_(std::move(folder)) {}
  std::filesystem::path folder_;
};

}  // namespace striae::store
