#include "store/objects.h"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sodium.h>
#include <unistd.h>

#include "store/detail/disk.h"
#include "store/detail/failed.h"

namespace striae::store {
namespace {

namespace fs = std::filesystem;
using detail::File;
using detail::HashFile;
using detail::MakeFolder;
using detail::Publish;
using detail::Refuse;
using detail::RefuseIo;
using detail::SyncFolder;
using detail::WriteWhole;

/// Removes the temporary file whatever happens.
struct Temporary {
  explicit Temporary(fs::path p) : path(std::move(p)) {}
  ~Temporary() { ::unlink(path.c_str()); }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  fs::path path;
};

}  // namespace

Sha256 HashOf(std::span<const std::uint8_t> bytes) {
  Sha256 digest;
  crypto_hash_sha256(digest.bytes.data(), bytes.data(), bytes.size());
  return digest;
}

Result<ObjectStore> ObjectStore::Open(const fs::path& folder) {
  return detail::Guarded([&] {
    MakeFolder(folder);
    return ObjectStore(folder);
  });
}

fs::path ObjectStore::PathOf(const Sha256& sha256) const {
  const std::string name = sha256.ToString();
  return folder_ / name.substr(0, 2) / name.substr(2);
}

bool ObjectStore::Has(const Sha256& sha256) const {
  std::error_code code;
  return fs::is_regular_file(PathOf(sha256), code);
}

Result<Sha256> ObjectStore::Put(std::span<const std::uint8_t> bytes) const {
  return detail::Guarded([&] {
    const Sha256 sha256 = HashOf(bytes);
    const fs::path target = PathOf(sha256);
    if (!Has(sha256)) {
      MakeFolder(target.parent_path());
      std::string name = (folder_ / ".part-XXXXXX").string();
      const File file(::mkostemp(name.data(), O_CLOEXEC));
      if (file.get() < 0) RefuseIo("write in", folder_, errno);
      const Temporary temporary(name);
      WriteWhole(file.get(), temporary.path, bytes);
      if (Publish(temporary.path, target)) {
        SyncFolder(target.parent_path());
        return sha256;
      }
    }
    if (HashFile(target) != sha256) {
      Refuse(ErrorCode::kRecordDamaged, "object " + sha256.ToString() +
                                            " is in the study already, but its content was altered; run 'striae check' "
                                            "and restore it from a backup");
    }
    SyncFolder(target.parent_path());  // a program killed just before may not have come this far
    return sha256;
  });
}

Result<std::vector<std::uint8_t>> ObjectStore::Get(const Sha256& sha256) const {
  return detail::Guarded([&] {
    const fs::path path = PathOf(sha256);
    if (!Has(sha256)) {
      Refuse(ErrorCode::kNotFound, "object " + sha256.ToString() +
                                       " is missing from the study; run 'striae check', restore it from a backup");
    }
    auto bytes = detail::ReadWhole(path);
    if (HashOf(bytes) != sha256) {
      Refuse(ErrorCode::kRecordDamaged, "object " + sha256.ToString() + " was altered or cut (" +
                                            std::to_string(bytes.size()) +
                                            " bytes); run 'striae check' and restore it from a backup");
    }
    return bytes;
  });
}

Status ObjectStore::Verify(const Sha256& sha256) const {
  return detail::Guarded([&] {
    if (!Has(sha256)) Refuse(ErrorCode::kNotFound, "is missing from objects/; restore it from a backup");
    if (HashFile(PathOf(sha256)) != sha256) {
      Refuse(ErrorCode::kRecordDamaged, "was altered or cut (" + std::to_string(fs::file_size(PathOf(sha256))) +
                                            " bytes); restore it from a backup");
    }
  });
}

Result<ObjectStore::Listing> ObjectStore::List() const {
  return detail::Guarded([&] {
    Listing listing;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      if (entry.is_directory() && entry.path().parent_path() == folder_) continue;
      const auto sha256 =
          Sha256::Parse(entry.path().parent_path().filename().string() + entry.path().filename().string());
      if (sha256 && entry.is_regular_file() && PathOf(*sha256) == entry.path()) {
        listing.objects.push_back(*sha256);
      } else {
        listing.strangers.push_back(entry.path());
      }
    }
    std::sort(listing.objects.begin(), listing.objects.end());
    std::sort(listing.strangers.begin(), listing.strangers.end());
    return listing;
  });
}

}  // namespace striae::store
