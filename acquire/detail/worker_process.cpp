#include "acquire/detail/worker_process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace striae::acquire::detail {
namespace {

namespace fs = std::filesystem;

/// The caller's environment with an own HOME (libgphoto2 keeps settings there that would outlive the shot) and plain
/// messages (the cause of a refused trigger stands in the text alone).
std::vector<std::string> Environment(const fs::path& home) {
  std::vector<std::string> variables;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string text = *variable;
    const bool ours = text.rfind("HOME=", 0) == 0 || text.rfind("LC_ALL=", 0) == 0 || text.rfind("LANGUAGE=", 0) == 0;
    if (!ours) variables.push_back(text);
  }
  variables.push_back("HOME=" + home.string());
  variables.emplace_back("LC_ALL=C");
  return variables;
}

std::vector<char*> Pointers(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (auto& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// posix_spawn's result: 0 or an errno.
int Spawn(const fs::path& program, const std::vector<std::string>& arguments, const fs::path& home, int pipe_end,
          pid_t& process) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_adddup2(&actions, pipe_end, kFrameDescriptor);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> variables = Environment(home);
  const int failed = ::posix_spawn(&process, program.c_str(), &actions, &attributes, Pointers(words).data(),
                                   Pointers(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  return failed;
}

}  // namespace

Result<WorkerProcess> WorkerProcess::Start(const fs::path& program, const std::vector<std::string>& arguments) {
  std::error_code code;
  if (!fs::exists(program, code)) {
    return Fail(ErrorCode::kNotFound,
                "the program " + program.string() + " is missing; install Striae completely (it talks to the camera)");
  }
  WorkerProcess worker;
  std::string home = (fs::temp_directory_path(code) / "striae-tether-XXXXXX").string();
  if (::mkdtemp(home.data()) == nullptr) {
    return Fail(ErrorCode::kIo, "cannot make a folder " + home + "; check the free space and TMPDIR");
  }
  worker.home_ = home;
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return Fail(ErrorCode::kIo, "no pipe for the tether worker");
  worker.pipe_ = ends[0];
  const int failed = Spawn(program, arguments, worker.home_, ends[1], worker.process_);
  ::close(ends[1]);
  if (failed != 0) {
    worker.process_ = -1;
    return Fail(ErrorCode::kDeviceFailed, "cannot start " + program.string() + " (" + std::strerror(failed) + ")");
  }
  return worker;
}

WorkerProcess::WorkerProcess(WorkerProcess&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      pipe_(std::exchange(other.pipe_, -1)),
      home_(std::exchange(other.home_, {})),
      parser_(std::move(other.parser_)) {}

WorkerProcess::~WorkerProcess() {
  if (pipe_ >= 0) ::close(pipe_);
  if (process_ > 0) {
    ::kill(-process_, SIGKILL);  // its whole group; SIGTERM often does not end a stalled libgphoto2
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  std::error_code ignored;
  if (!home_.empty()) fs::remove_all(home_, ignored);
}

WorkerProcess::Read WorkerProcess::Next(std::chrono::steady_clock::time_point deadline, Frame& frame) {
  while (true) {
    if (auto next = parser_.Next()) {
      frame = std::move(*next);
      return Read::kFrame;
    }
    if (parser_.broken()) return Read::kEnd;
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) return Read::kTimeout;
    pollfd ready{pipe_, POLLIN, 0};
    const int polled = ::poll(&ready, 1, static_cast<int>(left.count()));
    if (polled == 0) return Read::kTimeout;
    if (polled < 0) {
      if (errno == EINTR) continue;
      return Read::kEnd;
    }
    std::array<std::uint8_t, 65536> block{};
    const ssize_t size = ::read(pipe_, block.data(), block.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return Read::kEnd;
    parser_.Append(block.data(), static_cast<std::size_t>(size));
  }
}

}  // namespace striae::acquire::detail
