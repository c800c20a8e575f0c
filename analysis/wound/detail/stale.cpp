#include "analysis/wound/detail/stale.h"

#include <string_view>

namespace striae::wound {

std::optional<Sha256> PhotographOf(const Surface& surface) {
  constexpr std::string_view kStart = "photograph sha256 ";
  for (const std::string& comment : surface.comments) {
    if (!comment.starts_with(kStart)) continue;
    const auto sha256 = Sha256::Parse(std::string_view(comment).substr(kStart.size()));
    if (sha256) return *sha256;
  }
  return std::nullopt;
}

}  // namespace striae::wound
