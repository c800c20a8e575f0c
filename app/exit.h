// CONTRACT's exit codes, and how an error is said.
#pragma once

#include <exception>
#include <iostream>
#include <new>

#include "core/result.h"

namespace striae::app {

constexpr int kExitDone = 0, kExitFailed = 1, kExitUsage = 2;

inline int ReportError(const Error& error) {
  std::cerr << "striae: " << error.Describe() << " [" << ToString(error.code) << "]\n";
  return error.code == ErrorCode::kUsage ? kExitUsage : kExitFailed;
}

/// Runs the program's body; what it throws becomes a message.
template <typename Body>
int Guarded(const Body& body) {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    std::cerr << "striae: not enough memory; close other programs or use a smaller photograph\n";
  } catch (const std::exception& e) {
    std::cerr << "striae: internal error: " << e.what() << "; please report it with the command that you ran\n";
  }
  return kExitFailed;
}

}  // namespace striae::app
