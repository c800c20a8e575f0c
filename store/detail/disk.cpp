#include "store/detail/disk.h"

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <sodium.h>
#include <sys/file.h>
#include <sys/stat.h>

#include "store/detail/failed.h"

namespace striae::store::detail {

namespace fs = std::filesystem;

namespace {

void Finish(int file, const fs::path& path) {
  if (::fchmod(file, 0444) != 0 || ::fsync(file) != 0) RefuseIo("write", path, errno);
}

void WriteSome(int file, const fs::path& path, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) RefuseIo("write", path, written == 0 ? ENOSPC : errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

/// Calls `use` with one block of the file after the other.
template <typename Use>
void EachBlock(const fs::path& path, Use use) {
  const File file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) RefuseIo("read", path, errno);
  std::vector<std::uint8_t> block(std::size_t{1} << 20);
  for (;;) {
    const ssize_t count = ::read(file.get(), block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) RefuseIo("read", path, errno);
    if (count == 0) return;
    use(std::span<const std::uint8_t>(block.data(), static_cast<std::size_t>(count)));
  }
}

/// A temporary file beside its later name; gone when it was not given that name.
class Draft {
 public:
  explicit Draft(const fs::path& target)
      : target_(target),
        name_((target.parent_path() / ".part-XXXXXX").string()),
        file_(::mkostemp(name_.data(), O_CLOEXEC)) {
    if (file_.get() < 0) RefuseIo("write in", target.parent_path(), errno);
  }
  ~Draft() { ::unlink(name_.c_str()); }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  [[nodiscard]] int file() const { return file_.get(); }
  [[nodiscard]] const std::string& name() const { return name_; }
  void Publish() const {
    if (!detail::Publish(name_, target_)) {
      Refuse(ErrorCode::kRecordRefused, target_.string() + " is there already and is not overwritten");
    }
    SyncFolder(target_.parent_path());
  }

 private:
  fs::path target_;
  std::string name_;
  File file_;
};

}  // namespace

void RefuseIo(const char* what, const fs::path& path, int reason) {
  Refuse(ErrorCode::kIo, std::string("cannot ") + what + " " + path.string() + " (" + std::strerror(reason) +
                             "); check the study's folder, its permissions and the free space");
}

void SyncFolder(const fs::path& folder) {
  const File file(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (file.get() < 0 || ::fsync(file.get()) != 0) RefuseIo("sync", folder, errno);
}

FolderLock::FolderLock(const fs::path& folder) : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (folder_.get() < 0) RefuseIo("open", folder, errno);
  constexpr int kTries = 200;
  for (int i = 0; ::flock(folder_.get(), LOCK_SH | LOCK_NB) != 0; ++i) {
    if (errno != EWOULDBLOCK) return;
    if (i == kTries) {
      Refuse(ErrorCode::kIo, "another program repairs or restores " + folder.parent_path().string() +
                                 "; wait until it has finished, then repeat");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

bool FolderLock::TakeAlone() const { return ::flock(folder_.get(), LOCK_EX | LOCK_NB) == 0; }
void FolderLock::Share() const { ::flock(folder_.get(), LOCK_SH | LOCK_NB); }

void WriteWhole(int file, const fs::path& path, std::span<const std::uint8_t> bytes) {
  WriteSome(file, path, bytes);
  Finish(file, path);
}

bool Publish(const fs::path& temporary, const fs::path& target) {
  if (::link(temporary.c_str(), target.c_str()) == 0) return true;
  if (errno == EEXIST) return false;
  // File systems without hard links (exFAT): the rename that refuses to overwrite.
  if (::renameat2(AT_FDCWD, temporary.c_str(), AT_FDCWD, target.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno == EEXIST) return false;
  RefuseIo("name", target, errno);
}

void WriteNew(const fs::path& path, std::span<const std::uint8_t> bytes) {
  const Draft draft(path);
  WriteWhole(draft.file(), draft.name(), bytes);
  draft.Publish();
}

Sha256 CopyNew(const fs::path& from, const fs::path& to, const Sha256* expected) {
  const Draft draft(to);
  crypto_hash_sha256_state state;
  crypto_hash_sha256_init(&state);
  EachBlock(from, [&](std::span<const std::uint8_t> block) {
    crypto_hash_sha256_update(&state, block.data(), block.size());
    WriteSome(draft.file(), draft.name(), block);
  });
  Sha256 digest;
  crypto_hash_sha256_final(&state, digest.bytes.data());
  if (expected != nullptr && digest != *expected) {
    Refuse(ErrorCode::kRecordDamaged, from.string() +
                                          " was altered or cut: it is not what its name says; run 'striae "
                                          "check' on the study that it is in");
  }
  Finish(draft.file(), draft.name());
  draft.Publish();
  return digest;
}

bool MoveNew(const fs::path& from, const fs::path& to) {
  if (!Publish(from, to)) return false;
  ::unlink(from.c_str());  // still there after a link; after a rename there is nothing to remove
  SyncFolder(to.parent_path());
  SyncFolder(from.parent_path());
  return true;
}

Sha256 HashFile(const fs::path& path) {
  crypto_hash_sha256_state state;
  crypto_hash_sha256_init(&state);
  EachBlock(path, [&](std::span<const std::uint8_t> block) {
    crypto_hash_sha256_update(&state, block.data(), block.size());
  });
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
