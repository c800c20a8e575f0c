#include "store/detail/disk.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>

#include "store/detail/failed.h"

namespace striae::store::detail {

namespace fs = std::filesystem;

void RefuseIo(const char* what, const fs::path& path, int reason) {
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

std::vector<std::uint8_t> ReadWhole(const fs::path& path) {
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
  return bytes;
}

}  // namespace striae::store::detail
