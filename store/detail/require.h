// What every change of something that is there already needs.
#pragma once

#include <string>

#include "store/detail/failed.h"

namespace striae::store::detail {

/// kUsage unless there is a reason. `what` begins the sentence: "a change of the plan".
inline void RequireReason(const std::string& reason, const std::string& what) {
  if (reason.empty()) Refuse(ErrorCode::kUsage, what + " needs a reason; give --reason");
}

inline void RequireText(const std::string& text, const std::string& what) {
  constexpr std::size_t kMost = 10'000;
  if (text.empty() || text.size() > kMost) Refuse(ErrorCode::kUsage, what + " needs a text of 1 to 10000 characters");
}

}  // namespace striae::store::detail
