#include "store/objects.h"

#include <algorithm>
#include <array>
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

ObjectStore::ObjectStore(fs::path folder)
    : folder_(std::move(folder)), lock_(std::make_shared<detail::FolderLock>(folder_)) {}

Status ObjectStore::TakeAlone() const {
  if (lock_->TakeAlone()) return {};
  lock_->Share();
  return Fail(ErrorCode::kIo, "another program has this study open; close it, then repeat");
}

void ObjectStore::Share() const { lock_->Share(); }

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

Result<Sha256> ObjectStore::Put(std::span<const std::uint8_t> bytes) const { return Put(bytes, HashOf(bytes)); }

Result<Sha256> ObjectStore::Put(std::span<const std::uint8_t> bytes, const Sha256& sha256) const {
  return detail::Guarded([&] {
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

Status ObjectStore::PutFile(const fs::path& file, const Sha256& expected) const {
  return detail::Guarded([&] {
    const fs::path target = PathOf(expected);
    if (Has(expected)) {
      detail::Unwrap(Verify(expected));
      return;
    }
    MakeFolder(target.parent_path());
    detail::CopyNew(file, target, &expected);
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

Status ObjectStore::Verify(const Sha256& sha256, std::uint64_t size_bytes) const {
  Status status = Verify(sha256);
  if (status || status.error().code != ErrorCode::kRecordDamaged) return status;
  std::error_code code;
  const auto size = fs::file_size(PathOf(sha256), code);
  const std::string of = std::to_string(size) + " of " + std::to_string(size_bytes) + " bytes";
  const std::string what = size < size_bytes   ? "was cut: " + of + " are left"
                           : size > size_bytes ? "was altered: it has " + of
                                               : "was altered: its bytes are not those of its name";
  return Fail(ErrorCode::kRecordDamaged, what + "; restore it from a backup ('striae check --repair --from BACKUP')");
}

Result<ObjectStore::Listing> ObjectStore::List() const {
  Listing all;
  for (int part = 0; part < 256; ++part) {
    auto some = ListPart(static_cast<std::uint8_t>(part));
    if (!some) return some;
    all.objects.insert(all.objects.end(), some->objects.begin(), some->objects.end());
    all.strangers.insert(all.strangers.end(), some->strangers.begin(), some->strangers.end());
  }
  std::sort(all.strangers.begin(), all.strangers.end());
  return all;
}

Result<ObjectStore::Listing> ObjectStore::ListPart(std::uint8_t first_byte) const {
  return detail::Guarded([&] {
    Listing listing;
    const fs::path part = folder_ / ToHex(std::array{first_byte});
    const auto is_part = [&](const fs::directory_entry& entry) {
      std::array<std::uint8_t, 1> byte{};
      return entry.is_directory() && FromHex(entry.path().filename().string(), byte) &&
             ToHex(byte) == entry.path().filename().string();
    };
    const auto add_strangers = [&](const fs::directory_entry& entry) {
      if (!entry.is_directory()) listing.strangers.push_back(entry.path());
      if (!entry.is_directory()) return;
      for (const auto& below : fs::recursive_directory_iterator(entry.path())) {
        if (!below.is_directory()) listing.strangers.push_back(below.path());
      }
    };
    if (first_byte == 0) {
      for (const auto& entry : fs::directory_iterator(folder_)) {
        if (!is_part(entry)) add_strangers(entry);
      }
    }
    if (fs::is_directory(part)) {
      for (const auto& entry : fs::directory_iterator(part)) {
        const auto sha256 = Sha256::Parse(part.filename().string() + entry.path().filename().string());
        const bool is_object = sha256 && entry.is_regular_file() && PathOf(*sha256) == entry.path();
        if (is_object) listing.objects.push_back(*sha256);
        if (!is_object) add_strangers(entry);
      }
    }
    std::sort(listing.objects.begin(), listing.objects.end());
    std::sort(listing.strangers.begin(), listing.strangers.end());
    return listing;
  });
}

}  // namespace striae::store
