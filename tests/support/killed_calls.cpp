// The C library's calls that change a file, with a kill -9 before the n-th: linked into a test that forks, or preloaded
// into a whole program (STRIAE_TEST_KILL_AT=n; STRIAE_TEST_COUNT=FILE writes how many there were instead). They stand
// before the system's own, SQLite's and libsodium's included. A write is cut in the middle first.
#include "tests/support/killed_calls.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

long striae_test_calls_left = -1;

namespace {

long calls_made = 0;

/// True at the call that is the last.
bool IsLast() {
  ++calls_made;
  return striae_test_calls_left >= 0 && striae_test_calls_left-- == 0;
}
[[noreturn]] void Die() {
  ::kill(::getpid(), SIGKILL);
  ::_exit(1);
}
template <typename Function>
Function* System(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

/// What the environment asks of a program that has this preloaded.
struct Asked {
  Asked() {
    if (const char* at = std::getenv("STRIAE_TEST_KILL_AT")) striae_test_calls_left = std::atol(at);
  }
  ~Asked() {
    const char* file = std::getenv("STRIAE_TEST_COUNT");
    if (file == nullptr) return;
    const long made = calls_made;
    std::FILE* out = std::fopen(file, "w");
    if (out == nullptr) return;
    std::fprintf(out, "%ld", made);
    std::fclose(out);
  }
  Asked(const Asked&) = delete;
  Asked& operator=(const Asked&) = delete;
} asked;

}  // namespace

extern "C" {

ssize_t write(int file, const void* data, size_t size) {
  static auto* const system = System<ssize_t(int, const void*, size_t)>("write");
  if (file == STDOUT_FILENO || file == STDERR_FILENO) return system(file, data, size);  // the program's own words
  if (!IsLast()) return system(file, data, size);
  (void)system(file, data, size / 2);
  Die();
}
ssize_t pwrite64(int file, const void* data, size_t size, off64_t at) {
  static auto* const system = System<ssize_t(int, const void*, size_t, off64_t)>("pwrite64");
  if (!IsLast()) return system(file, data, size, at);
  (void)system(file, data, size / 2, at);
  Die();
}
ssize_t pwrite(int file, const void* data, size_t size, off_t at) { return pwrite64(file, data, size, at); }
int fsync(int file) {
  static auto* const system = System<int(int)>("fsync");
  if (IsLast()) Die();
  return system(file);
}
int fdatasync(int file) {
  static auto* const system = System<int(int)>("fdatasync");
  if (IsLast()) Die();
  return system(file);
}
int link(const char* from, const char* to) noexcept {
  static auto* const system = System<int(const char*, const char*)>("link");
  if (IsLast()) Die();
  return system(from, to);
}
int unlink(const char* name) noexcept {
  static auto* const system = System<int(const char*)>("unlink");
  if (IsLast()) Die();
  return system(name);
}
int rename(const char* from, const char* to) noexcept {
  static auto* const system = System<int(const char*, const char*)>("rename");
  if (IsLast()) Die();
  return system(from, to);
}
int ftruncate64(int file, off64_t size) noexcept {
  static auto* const system = System<int(int, off64_t)>("ftruncate64");
  if (IsLast()) Die();
  return system(file, size);
}
int mkdir(const char* name, mode_t mode) noexcept {
  static auto* const system = System<int(const char*, mode_t)>("mkdir");
  if (IsLast()) Die();
  return system(name, mode);
}

}  // extern "C"
