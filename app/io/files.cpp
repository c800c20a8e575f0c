#include "app/io/files.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace striae::app {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> WriteFailed(const fs::path& path, int reason) {
  return Fail(ErrorCode::kIo, "cannot write " + path.string() + " (" + std::strerror(reason) +
                                  "); check the folder, its permissions and the free space");
}

/// errno of the failure, 0 when the system has every byte.
int WriteAll(int file, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return errno == 0 ? EIO : errno;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return 0;
}

/// errno where there is no room. Where the file system cannot reserve, writing will tell.
int Reserve(int file, std::size_t bytes) {
#if defined(__linux__)
  if (bytes > 0 && ::fallocate(file, 0, 0, static_cast<off_t>(bytes)) != 0) {
    return errno == ENOSPC || errno == EFBIG || errno == EDQUOT ? errno : 0;
  }
#endif
  return 0;
}

}  // namespace

Result<std::vector<std::uint8_t>> ReadFile(const fs::path& path) {
  std::error_code code;
  if (!fs::exists(path, code)) {
    return Fail(ErrorCode::kNotFound, path.string() + " does not exist; check the name and the folder");
  }
  if (fs::is_directory(path, code)) return Fail(ErrorCode::kIo, path.string() + " is a folder, not a file");
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  const auto size = stream.tellg();
  std::vector<std::uint8_t> bytes(size > 0 ? static_cast<std::size_t>(size) : 0);
  stream.seekg(0);
  if (!bytes.empty()) stream.read(reinterpret_cast<char*>(bytes.data()), size);
  if (!stream) return Fail(ErrorCode::kIo, path.string() + " cannot be read; check its permissions");
  return bytes;
}

Result<std::string> ReadText(const fs::path& path) {
  const auto bytes = ReadFile(path);
  if (!bytes) return Fail(bytes.error());
  return std::string(bytes->begin(), bytes->end());
}

Status WriteFile(const fs::path& path, const std::function<bool(const ByteSink&)>& produce, Kept kept,
                 std::size_t expected) {
  std::error_code code;
  if (fs::is_directory(path, code)) return WriteFailed(path, EISDIR);
  // Beyond a limit on the size of files (ulimit -f) writing shall fail like a full disk, not end the program.
  static const auto unlimited = std::signal(SIGXFSZ, SIG_IGN);
  static_cast<void>(unlimited);
  std::string temporary = path.string() + ".part-XXXXXX";
  const int file = ::mkstemp(temporary.data());
  if (file < 0) return WriteFailed(path, errno);
  ::fchmod(file, 0644);
  int reason = Reserve(file, expected);
  std::size_t written = 0;
  const bool whole = reason == 0 && produce([&](std::span<const std::uint8_t> bytes) {
                       reason = WriteAll(file, bytes);
                       written += bytes.size();
                       return reason == 0;
                     });
  if (!whole && reason == 0) reason = EIO;
  if (reason == 0 && written < expected && ::ftruncate(file, static_cast<off_t>(written)) != 0) reason = errno;
  if (reason == 0 && kept == Kept::kDisk && ::fsync(file) != 0) reason = errno;
  if (::close(file) != 0 && reason == 0) reason = errno;
  if (reason == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) reason = errno;
  if (reason != 0) {
    ::unlink(temporary.c_str());
    return WriteFailed(path, reason);
  }
  return {};
}

Status WriteFile(const fs::path& path, std::span<const std::uint8_t> bytes, Kept kept) {
  return WriteFile(
      path, [bytes](const ByteSink& sink) { return sink(bytes); }, kept);
}

Status WriteText(const fs::path& path, std::string_view text) {
  return WriteFile(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace striae::app
