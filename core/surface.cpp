#include "core/surface.h"

#include <stdexcept>
#include <string_view>

namespace striae {
namespace {
constexpr std::string_view kWarning = "warning: ";
}

std::string WarningComment(const std::string& warning) { return std::string(kWarning) + warning; }

std::vector<std::string> Warnings(const Surface& surface) {
  std::vector<std::string> warnings;
  for (const std::string& comment : surface.comments) {
    if (comment.starts_with(kWarning)) warnings.push_back(comment.substr(kWarning.size()));
  }
  return warnings;
}

Image<std::int32_t> VertexIndexGrid(const Surface& surface) {
  if (!surface.HasGrid()) throw std::logic_error("VertexIndexGrid: surface without sensor pixels");
  Image<std::int32_t> grid(surface.sensor_width_px, surface.sensor_height_px, -1);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (grid.Contains(surface.col[i], surface.row[i])) {
      grid(surface.col[i], surface.row[i]) = static_cast<std::int32_t>(i);
    }
  }
  return grid;
}

}  // namespace striae
