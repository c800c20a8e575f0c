// Inside store/ a refusal travels as an exception, so that a transaction rolls back on its way out; Guarded turns it,
// and whatever SQLite throws, into a Result at the border of the module.
#pragma once

#include <exception>
#include <string>
#include <type_traits>
#include <utility>

#include "core/result.h"

namespace striae::store::detail {

struct Failed : std::exception {
  explicit Failed(Error e) : error(std::move(e)) {}
  [[nodiscard]] const char* what() const noexcept override { return error.message.c_str(); }
  Error error;
};

[[noreturn]] inline void Refuse(ErrorCode code, std::string message) {
  throw Failed(Error{code, std::move(message), {}});
}

/// The value, or the error thrown on.
template <typename T>
T Unwrap(Result<T> result) {
  if (!result) throw Failed(std::move(result.error()));
  if constexpr (!std::is_void_v<T>) return *std::move(result);
}

/// Must be called within a catch block: what is being handled, as an Error.
Error CurrentError();

/// Runs `work`; returns Result of its value.
template <typename Work>
auto Guarded(Work&& work) -> Result<std::invoke_result_t<Work>> {
  try {
    if constexpr (std::is_void_v<std::invoke_result_t<Work>>) {
      std::forward<Work>(work)();
      return {};
    } else {
      return std::forward<Work>(work)();
    }
  } catch (...) {
    return Fail(CurrentError());
  }
}

}  // namespace striae::store::detail
