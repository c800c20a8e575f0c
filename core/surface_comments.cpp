#include "core/surface_comments.h"

#include <cstdlib>
#include <string_view>

namespace striae {
namespace {
constexpr std::string_view kPhotograph = "photograph sha256 ";
}

std::string PhotographComment(const Sha256& photograph) { return std::string(kPhotograph) + photograph.ToString(); }

std::optional<Sha256> PhotographOf(const Surface& surface) {
  for (const std::string& comment : surface.comments) {
    if (!comment.starts_with(kPhotograph)) continue;
    const auto sha256 = Sha256::Parse(std::string_view(comment).substr(kPhotograph.size()));
    if (sha256) return *sha256;
  }
  return std::nullopt;
}

std::optional<double> CarrierPeriodOf(const Surface& surface) {
  constexpr std::string_view kStart = "carrier period px ";
  for (const std::string& comment : surface.comments) {
    if (!comment.starts_with(kStart)) continue;
    const double period = std::strtod(comment.c_str() + kStart.size(), nullptr);
    if (period > 2 && period < 1000) return period;
  }
  return std::nullopt;
}

}  // namespace striae
