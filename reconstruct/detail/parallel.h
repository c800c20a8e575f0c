// Splits lines of an image over the cores. Each line is computed alone, so results do not depend on their number.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <thread>
#include <vector>

#include "core/image.h"

namespace striae::reconstruct::detail {

/// All processors, or as many as the environment's STRIAE_THREADS says (to share a machine, or to check that results do
/// not depend on it).
inline int ThreadCount() {
  static const int count = [] {
    const char* wanted = std::getenv("STRIAE_THREADS");
    const int asked = wanted != nullptr ? std::atoi(wanted) : 0;
    return asked > 0 ? std::min(asked, 16) : static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 16U));
  }();
  return count;
}

/// Calls body(thread, first, last) for blocks of [0, count); `thread` < ThreadCount() is for scratch memory.
template <typename Body>
void ParallelBlocks(int count, const Body& body, int block = 32) {
  std::atomic<int> next{0};
  const auto work = [&](int thread) {
    for (int first = next.fetch_add(block); first < count; first = next.fetch_add(block)) {
      body(thread, first, std::min(count, first + block));
    }
  };
  std::vector<std::thread> others;
  for (int thread = 1; thread < ThreadCount(); ++thread) others.emplace_back(work, thread);
  work(0);
  for (std::thread& other : others) other.join();
}

/// Calls body(line) for every line.
template <typename Body>
void ParallelLines(int count, const Body& body) {
  ParallelBlocks(count, [&](int, int first, int last) {
    for (int line = first; line < last; ++line) body(line);
  });
}

/// Makes the system give an image's memory before several threads write to it in turns: two that touch a page first at
/// the same time both wait for it to be cleared, twice. For an image that is written over afterwards.
template <typename T>
void TouchPages(Image<T>& image) {
  constexpr std::size_t kPage = std::size_t{2} << 20;  // huge pages, core/buffer.h
  auto* bytes = reinterpret_cast<std::uint8_t*>(image.pixels().data());
  const std::size_t size = image.size() * sizeof(T);
  ParallelBlocks(
      static_cast<int>((size + kPage - 1) / kPage),
      [&](int, int page, int) { bytes[static_cast<std::size_t>(page) * kPage] = 0; }, 1);
}

}  // namespace striae::reconstruct::detail
