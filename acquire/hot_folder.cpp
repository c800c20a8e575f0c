#include "acquire/hot_folder.h"

#include <algorithm>
#include <array>
#include <utility>

#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include "acquire/folder.h"
#include "acquire/structure.h"

namespace striae::acquire {

namespace fs = std::filesystem;
using std::chrono::duration_cast;
using std::chrono::milliseconds;

HotFolder::HotFolder(fs::path folder, CaptureBinding binding, HotFolderOptions options)
    : folder_(std::move(folder)), binding_(std::move(binding)), options_(options) {
  // Where there is none (too many in use, a system without it), looking again does it all.
  if (options_.may_be_told) notifier_ = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
}

HotFolder::HotFolder(HotFolder&& other) noexcept
    : folder_(std::move(other.folder_)),
      binding_(std::move(other.binding_)),
      options_(other.options_),
      notifier_(std::exchange(other.notifier_, -1)),
      seen_(std::move(other.seen_)) {}

HotFolder& HotFolder::operator=(HotFolder&& other) noexcept {
  std::swap(folder_, other.folder_);
  std::swap(binding_, other.binding_);
  std::swap(options_, other.options_);
  std::swap(notifier_, other.notifier_);
  std::swap(seen_, other.seen_);
  return *this;
}

HotFolder::~HotFolder() {
  if (notifier_ >= 0) ::close(notifier_);
}

Result<HotFolder> HotFolder::Open(const fs::path& folder, const CaptureBinding& binding,
                                  const HotFolderOptions& options) {
  std::error_code code;
  if (!fs::is_directory(folder, code)) {
    return Fail(ErrorCode::kNotFound, folder.string() + " is no folder; name the one that photographs arrive in");
  }
  return HotFolder(folder, binding, options);
}

Status HotFolder::Look() {
  auto listed = ListFolder(folder_);
  if (!listed) return Fail(listed.error());
  if (notifier_ >= 0) {
    // Adding a folder again changes nothing; new folders are found so.
    for (const fs::path& folder : listed->folders) {
      ::inotify_add_watch(notifier_, folder.c_str(), IN_CLOSE_WRITE | IN_MOVED_TO | IN_CREATE);
    }
  }
  std::map<fs::path, Seen> now;
  for (fs::path& path : listed->files) {
    std::error_code code;
    Seen file;
    file.size = fs::file_size(path, code);
    if (!code) file.time = fs::last_write_time(path, code);
    if (code) continue;  // gone meanwhile
    file.since = Clock::now();
    const auto before = seen_.find(path);
    const bool same = before != seen_.end() && before->second.size == file.size && before->second.time == file.time;
    now[std::move(path)] = same ? before->second : file;
  }
  seen_ = std::move(now);
  return {};
}

std::optional<IngestItem> HotFolder::TakeComplete() {
  for (auto& [path, file] : seen_) {
    const auto rested = Clock::now() - file.since;
    if (file.is_done || rested < options_.settle || (file.is_broken && rested < options_.give_up)) continue;
    FolderSource source({path}, binding_);
    auto item = source.Next();
    std::error_code code;
    const bool same = fs::file_size(path, code) == file.size && !code && fs::last_write_time(path, code) == file.time;
    if (!item || !*item || !same || code) {
      file.since = Clock::now();  // unreadable for now, or still being written
      continue;
    }
    file.is_broken = !CheckStructure((*item)->bytes);
    if (file.is_broken && rested < options_.give_up) continue;
    file.is_done = true;
    return *std::move(item);
  }
  return std::nullopt;
}

void HotFolder::Await(milliseconds patience) {
  const auto waiting = std::any_of(seen_.begin(), seen_.end(), [](const auto& each) { return !each.second.is_done; });
  constexpr milliseconds kShort{50};
  const milliseconds pause = std::min(patience, waiting ? std::max(options_.settle / 2, kShort) : options_.look_again);
  pollfd polled{notifier_, POLLIN, 0};
  ::poll(&polled, notifier_ >= 0 ? 1 : 0, static_cast<int>(pause.count()));
  // What they say is not asked: the folder itself is.
  std::array<char, 4096> events;
  while (notifier_ >= 0 && ::read(notifier_, events.data(), events.size()) > 0) {
  }
}

Result<std::optional<IngestItem>> HotFolder::Next(milliseconds patience) {
  const auto deadline = Clock::now() + patience;
  while (true) {
    if (auto looked = Look(); !looked) return Fail(looked.error());
    if (auto item = TakeComplete()) return item;
    const auto left = duration_cast<milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return std::optional<IngestItem>();
    Await(left);
  }
}

}  // namespace striae::acquire
