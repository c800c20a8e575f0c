// A progress bar on stderr, and only when that is a terminal.
#pragma once

#include <cstddef>
#include <string>

namespace striae::app {

class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar() { Clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  void Show(std::size_t done, std::size_t all, const std::string& what);
  /// Removes the bar, so that a message can follow on a clean line.
  void Clear();

 private:
  bool on_terminal_, shown_ = false;
};

}  // namespace striae::app
