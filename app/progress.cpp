#include "app/progress.h"

#include <iostream>

#include <unistd.h>

namespace striae::app {

ProgressBar::ProgressBar() : on_terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressBar::Show(std::size_t done, std::size_t all, const std::string& what) {
  constexpr std::size_t kCells = 24;
  if (!on_terminal_) return;
  const std::size_t full = all == 0 ? kCells : kCells * done / all;
  std::cerr << "\r\x1b[K[" << std::string(full, '#') << std::string(kCells - full, '.') << "] " << done << "/" << all
            << "  " << what << std::flush;
  shown_ = true;
}

std::function<void(std::size_t, std::size_t, std::string_view)> ProgressBar::AsProgress() {
  if (!on_terminal_) return {};
  return [this](std::size_t done, std::size_t all, std::string_view what) {
    // Not more often than an eye can follow.
    constexpr std::size_t kSteps = 200;
    if (all > kSteps && done != all && done % (all / kSteps) != 0) return;
    Show(done, all, std::string(what));
  };
}

void ProgressBar::Clear() {
  if (shown_) std::cerr << "\r\x1b[K" << std::flush;
  shown_ = false;
}

}  // namespace striae::app
