#include "store/objects.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include "store/detail/failed.h"

namespace striae::store {
namespace {

namespace fs = std::filesystem;
using detail::Refuse;

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

[[noreturn]] void RefuseIo(const char* what, const fs::path& path, int reason) {
  Refuse(ErrorCode::kIo, std::string("cannot ") + what + " " + path.string() + " (" + std::strerror(reason) +
                             "); check the study's folder, its permissions and the free space");
}

void SyncFolder(const fs::path& folder) {
  const File file(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (file.get() < 0 || ::fsync(file.get()) != 0) RefuseIo("sync", folder, errno);
}

void WriteWhole(int file, const fs::path& path, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) RefuseIo("write", path, written == 0 ? ENOSPC : errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  if (::fchmod(file, 0444) != 0 || ::fsync(file) != 0) RefuseIo("write", path, errno);
}

/// Gives the finished file its name unless one is there. False when there is one.
bool Publish(const fs::path& temporary, const fs::path& target) {
  if (::link(temporary.c_str(), target.c_str()) == 0) return true;
  if (errno == EEXIST) return false;
  // File systems without hard links (exFAT): the rename that refuses to overwrite.
  if (::renameat2(AT_FDCWD, temporary.c_str(), AT_FDCWD, target.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno == EEXIST) return false;
  RefuseIo("name", target, errno);
}

Sha256 HashFile(const fs::path& path) {
  const File file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) RefuseIo("read", path, errno);
  crypto_hash_sha256_state state;
  crypto_hash_sha256_init(&state);
  std::vector<std::uint8_t> block(std::size_t{1} << 20);
  for (;;) {
    const ssize_t count = ::read(file.get(), block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) RefuseIo("read", path, errno);
    if (count == 0) break;
    crypto_hash_sha256_update(&state, block.data(), static_cast<unsigned long long>(count));
  }
  Sha256 digest;
  crypto_hash_sha256_final(&state, digest.bytes.data());
  return digest;
}

void MakeFolder(const fs::path& folder) {
  std::error_code code;
  if (fs::is_directory(folder, code)) return;
  fs::create_directory(folder, code);
  if (!fs::is_directory(folder)) RefuseIo("make", folder, code.value());
  SyncFolder(folder.parent_path());
}

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
    const File file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.get() < 0) RefuseIo("read", path, errno);
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(fs::file_size(path)));
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t count = ::read(file.get(), bytes.data() + done, bytes.size() - done);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) RefuseIo("read", path, errno);
      if (count == 0) break;
      done += static_cast<std::size_t>(count);
    }
    bytes.resize(done);
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
