// Rows shared among threads; who does which band never changes what a band holds.
#pragma once

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace striae::rig::detail {

/// Calls work(first, last) for consecutive bands [first, last) of rows on `threads` threads.
template <typename Work>
void ForEachBand(int rows, int band, int threads, const Work& work) {
  std::atomic<int> next{0};
  const auto take = [&] {
    for (int first = next.fetch_add(band); first < rows; first = next.fetch_add(band)) {
      work(first, std::min(rows, first + band));
    }
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(take);
  take();
  for (std::thread& other : others) other.join();
}

}  // namespace striae::rig::detail
