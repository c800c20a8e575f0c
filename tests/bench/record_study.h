// A study of the size of a large trial, filled through the record as the program fills it. Errors end the benchmark.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "store/record.h"

namespace striae::bench {

template <typename T>
T Must(Result<T> result) {
  if (result) return *std::move(result);
  std::fprintf(stderr, "%s\n", result.error().Describe().c_str());
  std::exit(1);
}
inline void Must(const Status& status) {
  if (status) return;
  std::fprintf(stderr, "%s\n", status.error().Describe().c_str());
  std::exit(1);
}

/// What was made, and what it took.
struct LargeStudy {
  int captures = 0, measurements = 0;
  double seconds = 0;
  long peak_kib_at_a_tenth = 0, peak_kib = 0;  ///< of this process
};

/// A plan of four visits, a session at each, five wound photographs of 20 kB a session, ten numbers a photograph.
LargeStudy MakeLargeStudy(const std::filesystem::path& folder, int subjects);

/// Another one for every number.
std::vector<std::uint8_t> PhotographBytes(int number, std::size_t size);

/// A photograph as import makes it, with its metadata and preflight; for a session that is open.
Capture NewCapture(const SessionId& session);

/// Counts up by a second: no clock.
store::Stamp NextStamp();

}  // namespace striae::bench
