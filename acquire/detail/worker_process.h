// The tether worker as its parent sees it: started with its own HOME, read with a deadline, ended for certain.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "acquire/detail/frame.h"
#include "core/result.h"

namespace striae::acquire::detail {

class WorkerProcess {
 public:
  /// kNotFound or kDeviceFailed when it cannot be started.
  static Result<WorkerProcess> Start(const std::filesystem::path& program, const std::vector<std::string>& arguments);
  WorkerProcess(WorkerProcess&& other) noexcept;
  WorkerProcess& operator=(WorkerProcess&&) = delete;
  ~WorkerProcess();  ///< kills what still runs and waits for its end

  enum class Read { kFrame, kEnd, kTimeout };
  /// Waits until a frame is whole, the worker has closed its pipe (or talks nonsense), or the deadline has passed.
  Read Next(std::chrono::steady_clock::time_point deadline, Frame& frame);

 private:
  WorkerProcess() = default;
  pid_t process_ = -1;
  int pipe_ = -1;
  std::filesystem::path home_;
  FrameParser parser_;
};

}  // namespace striae::acquire::detail
