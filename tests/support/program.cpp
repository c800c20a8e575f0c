#include "tests/support/program.h"

#include <array>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace striae::testing {
namespace {

struct Pipe {
  Pipe() {
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe failed");
  }
  void CloseWriter() { close(ends[1]); }
  std::array<int, 2> ends{};
};

[[noreturn]] void Become(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                         const std::filesystem::path& folder, const Pipe& out, const Pipe& err) {
  dup2(out.ends[1], 1);
  dup2(err.ends[1], 2);
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, 0);
  if (!folder.empty() && chdir(folder.c_str()) != 0) _exit(126);
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execvp(program.c_str(), pointers.data());
  _exit(127);
}

/// Reads both pipes until both end, so that neither can fill up and block the program.
void Drain(Pipe& out, Pipe& err, Ran& ran) {
  std::array<pollfd, 2> polled = {{{out.ends[0], POLLIN, 0}, {err.ends[0], POLLIN, 0}}};
  std::array<std::string*, 2> sinks = {&ran.out, &ran.err};
  std::array<char, 65536> buffer;
  while (polled[0].fd >= 0 || polled[1].fd >= 0) {
    poll(polled.data(), polled.size(), -1);
    for (std::size_t i = 0; i < polled.size(); ++i) {
      if (polled[i].fd < 0 || polled[i].revents == 0) continue;
      const ssize_t size = read(polled[i].fd, buffer.data(), buffer.size());
      if (size > 0) {
        sinks[i]->append(buffer.data(), static_cast<std::size_t>(size));
      } else {
        close(polled[i].fd);
        polled[i].fd = -1;
      }
    }
  }
}

}  // namespace

Ran RunProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments,
               const std::filesystem::path& folder) {
  Pipe out, err;
  const pid_t child = fork();
  if (child == 0) Become(program, arguments, folder, out, err);
  out.CloseWriter();
  err.CloseWriter();
  Ran ran;
  Drain(out, err, ran);
  int status = 0;
  waitpid(child, &status, 0);
  ran.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return ran;
}

bool OnPath(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (access((folder + "/" + program).c_str(), X_OK) == 0) return true;
  }
  return false;
}

}  // namespace striae::testing
