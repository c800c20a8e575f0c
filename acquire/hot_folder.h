// A folder that photographs arrive in: a card that is being read out, a share, what another program downloads to.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "acquire/source.h"

namespace striae::acquire {

struct HotFolderOptions {
  /// A file is taken when it is a whole photograph and has had the same size and time for so long.
  std::chrono::milliseconds settle{300};
  /// One that has not changed for so long and is still no whole photograph is handed out as it is, for quarantine.
  std::chrono::milliseconds give_up{10000};
  /// How often the folder is listed without being told of a change. Network folders tell nothing.
  std::chrono::milliseconds look_again{1000};
  bool may_be_told = true;  ///< by inotify; false: only by looking again
};

/// Hands out each photograph once it is complete; those that lie there already, and those in folders below, included.
/// The kernel's word (inotify: written and closed, moved in, created) only says when to look: what is there is decided
/// by listing the folder, so that events that are lost, doubled or early do no harm. Names are those of
/// ListPhotographs; a file that is changed or touched afterwards comes again, and the record then says that it is
/// there already. Nothing in the folder is changed.
class HotFolder {
 public:
  /// kNotFound when it is no folder.
  static Result<HotFolder> Open(const std::filesystem::path& folder, const CaptureBinding& binding,
                                const HotFolderOptions& options = {});
  HotFolder(HotFolder&&) noexcept;
  HotFolder& operator=(HotFolder&&) noexcept;
  ~HotFolder();

  /// The next one, or nothing when none is complete after `patience`. kNotFound when the folder
  /// is gone (the card was pulled out).
  Result<std::optional<IngestItem>> Next(std::chrono::milliseconds patience);
  /// True where the kernel tells of changes.
  [[nodiscard]] bool IsTold() const { return notifier_ >= 0; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Seen {
    std::uintmax_t size = 0;
    std::filesystem::file_time_type time;
    Clock::time_point since;  ///< it has had them
    bool is_broken = false;
    bool is_done = false;
  };
  HotFolder(std::filesystem::path folder, CaptureBinding binding, HotFolderOptions options);
  Status Look();
  std::optional<IngestItem> TakeComplete();
  void Await(std::chrono::milliseconds patience);

  std::filesystem::path folder_;
  CaptureBinding binding_;
  HotFolderOptions options_;
  int notifier_ = -1;
  std::map<std::filesystem::path, Seen> seen_;
};

}  // namespace striae::acquire
