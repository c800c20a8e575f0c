#include "acquire/tether.h"

#include <array>
#include <system_error>
#include <utility>

#include "acquire/detail/worker_process.h"

namespace striae::acquire {
namespace {

using Clock = std::chrono::steady_clock;
using detail::Frame;
using detail::WorkerProcess;

struct Advice {
  const char* kind;
  const char* text;
};

/// What a person does about each kind of failure that the worker reports.
constexpr std::array<Advice, 13> kAdvice{{
    {"absent",
     "no Nikon D90 was found; switch it on, connect the cable, and wake it with its shutter button half pressed"},
    {"claimed",
     "another program holds the camera; close it (on desktops often the file manager's gvfs-gphoto2-volume-monitor)"},
    {"wrong-model", "this is not a Nikon D90; connect the rig's camera"},
    {"no-card-target", "the camera does not let photographs be kept on its card; set it to record on the card"},
    {"out-of-focus", "the camera refused the shot: out of focus; set manual focus at the rig's mark"},
    {"store-full", "the camera refused the shot: its card is full; copy the card, import it, and put in an empty one"},
    {"no-card", "the camera refused the shot: no card, or the card is locked; put in a card"},
    {"busy", "the camera stays busy; wait until the flash is charged and the card's lamp is off, and try again"},
    {"refused", "the camera refused the shot; look at its display"},
    {"not-announced",
     "the shot was triggered but the camera announced no file; it may be on the card: import the card"},
    {"short", "the transfer came out short; the photograph is on the card: import the card"},
    {"transfer", "the transfer failed; the photograph is on the card: check the cable and import the card"},
    {"link", "the connection to the camera failed; check cable, battery and the port's name"},
}};

Error DeviceError(const std::string& kind, const std::string& details) {
  std::string text = "the camera failed in a way that Striae does not know; switch it off and on";
  for (const auto& advice : kAdvice) {
    if (kind == advice.kind) text = advice.text;
  }
  if (!details.empty()) text += " (" + details + ")";
  return Error{ErrorCode::kDeviceFailed, text, {}};
}

std::string Text(const nlohmann::json& header, const char* key) {
  const auto found = header.find(key);
  return found != header.end() && found->is_string() ? found->get<std::string>() : "";
}

/// Where the worker is, and how long it may stay there without a word.
struct Phase {
  std::string name = "connect";
  std::chrono::milliseconds limit{};
};

Phase PhaseOf(const std::string& name, const TetherOptions& options) {
  // The worker has its own limits for trigger and announcement; the watchdog leaves it a little more.
  constexpr std::chrono::milliseconds kGrace{3000};
  if (name == "trigger") return {name, options.trigger + kGrace};
  if (name == "announce") return {name, options.announce + kGrace};
  if (name == "transfer") return {name, options.stall};
  return {name, options.connect};
}

Error Stalled(const std::string& phase) {
  if (phase == "connect") return DeviceError("absent", "it did not answer in time");
  if (phase == "trigger")
    return DeviceError("link", "it stopped answering at the trigger; the shot may be on the card");
  if (phase == "announce") return DeviceError("not-announced", "it stopped answering");
  return DeviceError("transfer", "it stopped in the middle of the file");
}

}  // namespace

std::filesystem::path WorkerBesideProgram() {
  std::error_code code;
  return std::filesystem::read_symlink("/proc/self/exe", code).parent_path() / "striae-tether-worker";
}

TetherSource::TetherSource(TetherOptions options, CaptureBinding binding, int shots)
    : options_(std::move(options)), binding_(std::move(binding)), shots_left_(shots) {
  if (options_.worker.empty()) options_.worker = WorkerBesideProgram();
}

Result<std::optional<IngestItem>> TetherSource::Next() {
  while (arrived_.empty() && !failure_ && shots_left_ > 0) {
    --shots_left_;
    TakeOne();
  }
  if (!arrived_.empty()) {
    IngestItem item = std::move(arrived_.front());
    arrived_.pop_front();
    return std::optional(std::move(item));
  }
  if (failure_) {
    shots_left_ = 0;
    return Fail(*std::exchange(failure_, std::nullopt));
  }
  return std::optional<IngestItem>();
}

void TetherSource::TakeOne() {
  auto worker = WorkerProcess::Start(options_.worker, {options_.port, std::to_string(options_.trigger.count()),
                                                       std::to_string(options_.announce.count())});
  if (!worker) {
    failure_ = worker.error();
    return;
  }
  Phase phase = PhaseOf("connect", options_);
  bool took_ours = false;
  while (true) {
    Frame frame;
    const auto read = worker->Next(Clock::now() + phase.limit, frame);
    if (read == WorkerProcess::Read::kTimeout) failure_ = Stalled(phase.name);
    if (read == WorkerProcess::Read::kEnd)
      failure_ = DeviceError("link", "the tether worker ended during " + phase.name);
    if (failure_) return;
    const std::string tag = Text(frame.header, "tag");
    if (tag == "phase") phase = PhaseOf(Text(frame.header, "name"), options_);
    if (tag == "fail") failure_ = DeviceError(Text(frame.header, "kind"), Text(frame.header, "text"));
    if (tag == "file") {
      IngestItem item;
      item.bytes = std::move(frame.bytes);
      item.file_name = Text(frame.header, "name");
      item.origin =
          "camera " + Text(frame.header, "serial") + " " + Text(frame.header, "folder") + "/" + item.file_name;
      if (frame.header.value("ours", false)) item.binding = binding_;
      took_ours = took_ours || item.binding.has_value();
      arrived_.push_back(std::move(item));
    }
    if (tag == "done" && !took_ours) failure_ = DeviceError("not-announced", "");
    if (failure_ || tag == "done") return;
  }
}

}  // namespace striae::acquire
