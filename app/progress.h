// A progress bar on stderr, and only when that is a terminal.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace striae::app {

class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar() { Clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  void Show(std::size_t done, std::size_t all, const std::string& what);
  /// For what reports its progress by a call; empty when nobody looks. The bar must outlive it.
  std::function<void(std::size_t, std::size_t, std::string_view)> AsProgress();
  /// Removes the bar, so that a message can follow on a clean line.
  void Clear();

 private:
  bool on_terminal_, shown_ = false;
};

}  // namespace striae::app
