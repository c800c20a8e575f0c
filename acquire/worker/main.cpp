// striae-tether-worker PORT TRIGGER_MS ANNOUNCE_MS: takes one photograph and writes frames to descriptor 3.
// Started by acquire/tether.cpp only; it ends with its parent.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <sys/prctl.h>
#include <unistd.h>

#include "acquire/detail/frame.h"
#include "acquire/worker/detail/camera.h"

namespace striae::acquire::worker {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr int kSliceMs = 300;  // one wait for events; longer ones are not needed and up to 500 ms are known to end
constexpr milliseconds kBusyPause{250};
constexpr milliseconds kQuietAfterComplete{300};  // no further file of this shot
constexpr milliseconds kQuiet{3000};              // the same without a word that the shot is complete

void Send(nlohmann::json header, std::vector<std::uint8_t> bytes = {}) {
  if (!detail::WriteFrame(detail::kFrameDescriptor, {std::move(header), std::move(bytes)})) {
    std::_Exit(1);  // nobody listens any more
  }
}
void EnterPhase(const char* name) { Send({{"tag", "phase"}, {"name", name}}); }

/// Name without folder and ending: JPEG and NEF of one shot share it.
std::string Stem(const FileName& file) { return file.folder + "/" + file.name.substr(0, file.name.rfind('.')); }

class Shot {
 public:
  Shot(Camera& camera, milliseconds trigger, milliseconds announce)
      : camera_(camera), trigger_limit_(trigger), announce_limit_(announce) {}

  Failure Take(const std::string& port) {
    EnterPhase("connect");
    if (auto failure = camera_.Open(port); !failure.kind.empty()) return failure;
    serial_ = camera_.Serial();
    const std::string model = camera_.Model();
    if (!model.empty() && model.find("D90") == std::string::npos) return {"wrong-model", 0, model};
    if (auto failure = camera_.UseCard(); !failure.kind.empty()) return failure;
    if (auto failure = Drain(); !failure.kind.empty()) return failure;
    EnterPhase("trigger");
    if (auto failure = Trigger(); !failure.kind.empty()) return failure;
    EnterPhase("announce");
    if (auto failure = Collect(); !failure.kind.empty()) return failure;
    EnterPhase("transfer");
    return Transfer();
  }

 private:
  /// Files that appeared before our trigger are somebody else's doing.
  Failure Drain() {
    const auto end = Clock::now() + milliseconds(2000);
    while (Clock::now() < end) {
      Event event{};
      FileName file;
      if (auto failure = camera_.Wait(100, event, file); !failure.kind.empty()) return failure;
      if (event == Event::kNone) return {};
      if (event == Event::kFile) Keep(file, strangers_);
    }
    return {};
  }

  Failure Trigger() {
    const auto end = Clock::now() + trigger_limit_;
    while (true) {
      Failure failure = camera_.Trigger();
      if (failure.kind != "busy" || Clock::now() >= end) return failure;
      Send({{"tag", "beat"}});
      std::this_thread::sleep_for(kBusyPause);
    }
  }

  Failure Collect() {
    const auto end = Clock::now() + announce_limit_;
    auto last_news = Clock::now();
    bool complete = false;
    while (Clock::now() < end) {
      Event event{};
      FileName file;
      if (auto failure = camera_.Wait(kSliceMs, event, file); !failure.kind.empty()) {
        return ours_.empty() ? failure : Failure{};  // what was announced can still be fetched
      }
      const auto now = Clock::now();
      if (event == Event::kComplete) complete = true;
      if (event == Event::kFile && Add(file)) last_news = now;
      if (!ours_.empty() && now - last_news > (complete ? kQuietAfterComplete : kQuiet)) return {};
    }
    return ours_.empty() ? Failure{"not-announced", 0, ""} : Failure{};
  }

  /// The first new file is ours, and so are those of the same name with another ending.
  bool Add(const FileName& file) {
    if (std::find(strangers_.begin(), strangers_.end(), file) != strangers_.end()) return false;
    const bool ours = ours_.empty() || Stem(file) == Stem(ours_.front());
    return Keep(file, ours ? ours_ : strangers_);
  }
  /// Both of the camera's ways of announcing report the same file; it is kept once.
  static bool Keep(const FileName& file, std::vector<FileName>& files) {
    if (std::find(files.begin(), files.end(), file) != files.end()) return false;
    files.push_back(file);
    return true;
  }

  Failure Transfer() {
    for (const auto* files : {&ours_, &strangers_}) {
      for (const auto& file : *files) {
        std::vector<std::uint8_t> bytes;
        if (auto failure = camera_.Fetch(file, bytes); !failure.kind.empty()) return failure;
        Send({{"tag", "file"},
              {"folder", file.folder},
              {"name", file.name},
              {"serial", serial_},
              {"ours", files == &ours_}},
             std::move(bytes));
      }
    }
    return {};
  }

  Camera& camera_;
  milliseconds trigger_limit_, announce_limit_;
  std::string serial_;
  std::vector<FileName> ours_, strangers_;
};

int Run(char** argv) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::signal(SIGPIPE, SIG_IGN);
  Camera camera([] { Send({{"tag", "beat"}}); });
  Shot shot(camera, milliseconds(std::atoi(argv[2])), milliseconds(std::atoi(argv[3])));
  const Failure failure = shot.Take(argv[1]);
  if (failure.kind.empty()) {
    Send({{"tag", "done"}});
    return 0;
  }
  Send({{"tag", "fail"}, {"kind", failure.kind}, {"code", failure.code}, {"text", failure.text}});
  return 1;
}

}  // namespace
}  // namespace striae::acquire::worker

int main(int argc, char** argv) { return argc == 4 ? striae::acquire::worker::Run(argv) : 2; }
