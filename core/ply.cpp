#include "core/ply.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <Eigen/Core>

#include "core/detail/ply_header.h"

namespace striae {
namespace {

using detail::PlyElement;
using detail::PlyHeader;
using detail::PlyReader;

using detail::kSensorComment;

/// Where each wanted property of the vertex element stands; -1 where the file has none.
struct VertexColumns {
  explicit VertexColumns(const PlyElement& element) {
    constexpr const char* kNames[kWanted] = {"x",    "y",       "z",   "red", "green",
                                             "blue", "quality", "col", "row", "uncertainty"};
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      for (int wanted = 0; wanted < kWanted; ++wanted) {
        if (element.properties[i].name == kNames[wanted]) at[wanted] = static_cast<int>(i);
      }
    }
  }
  [[nodiscard]] bool Has(int first, int last) const {
    return std::all_of(at + first, at + last + 1, [](int column) { return column >= 0; });
  }
  static constexpr int kWanted = 10;
  int at[kWanted] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
};

std::uint16_t PixelOf(double value) { return static_cast<std::uint16_t>(std::clamp(value, 0.0, 65535.0)); }

std::uint8_t ChannelOf(double value) { return static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0)); }

Status ReadVertices(PlyReader& reader, const PlyElement& element, Surface& surface) {
  const VertexColumns columns(element);
  if (!columns.Has(0, 2)) return Fail(ErrorCode::kBadFile, "the PLY's vertices have no x, y, z");
  const bool coloured = columns.Has(3, 5), weighted = columns.Has(6, 6), gridded = columns.Has(7, 8),
             doubted = columns.Has(9, 9);
  std::vector<double> values(element.properties.size());
  for (std::size_t i = 0; i < element.count; ++i) {
    if (!reader.ReadScalars(element, values)) return Fail(ErrorCode::kBadFile, "the PLY ends within its vertices");
    const auto value = [&](int wanted) { return values[static_cast<std::size_t>(columns.at[wanted])]; };
    const Eigen::Vector3d point(value(0), value(1), value(2));
    if (!point.allFinite())
      return Fail(ErrorCode::kBadFile, "vertex " + std::to_string(i) + " of the PLY is not finite");
    surface.point_in_camera.push_back(point.cast<float>());
    surface.colour.push_back(coloured ? Rgb8{ChannelOf(value(3)), ChannelOf(value(4)), ChannelOf(value(5))}
                                      : detail::kUnsaidColour);
    surface.quality.push_back(weighted && std::isfinite(value(6)) ? static_cast<float>(value(6))
                                                                  : detail::kUnsaidQuality);
    if (gridded) {
      surface.col.push_back(PixelOf(value(7)));
      surface.row.push_back(PixelOf(value(8)));
    }
    if (doubted) {
      if (!(std::isfinite(value(9)) && value(9) >= 0))
        return Fail(ErrorCode::kBadFile, "the uncertainty of vertex " + std::to_string(i) + " of the PLY is none");
      surface.uncertainty_mm.push_back(static_cast<float>(value(9)));
    }
  }
  return {};
}

Status ReadFaces(PlyReader& reader, const PlyElement& element, Surface& surface) {
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < element.count; ++i) {
    if (!reader.ReadFace(element, corners)) return Fail(ErrorCode::kBadFile, "the PLY ends within its faces");
    for (const std::uint32_t corner : corners) {
      if (corner >= surface.size()) {
        return Fail(ErrorCode::kBadFile, "face " + std::to_string(i) + " of the PLY names a vertex that is not there");
      }
    }
    for (std::size_t k = 2; k < corners.size(); ++k) surface.faces.push_back({corners[0], corners[k - 1], corners[k]});
  }
  return {};
}

void ReadComments(const PlyHeader& header, Surface& surface) {
  for (const std::string& comment : header.comments) {
    if (comment.starts_with(kSensorComment)) {
      std::sscanf(comment.c_str() + kSensorComment.size(), "%d %d", &surface.sensor_width_px,
                  &surface.sensor_height_px);
    } else if (!comment.starts_with("units mm")) {
      surface.comments.push_back(comment);
    }
  }
}

/// The sensor holds every pixel that the vertices name, whatever the comment said.
void SettleSensorSize(Surface& surface) {
  const int cols = surface.col.empty() ? 0 : *std::max_element(surface.col.begin(), surface.col.end()) + 1;
  const int rows = surface.row.empty() ? 0 : *std::max_element(surface.row.begin(), surface.row.end()) + 1;
  surface.sensor_width_px = std::clamp(std::max(surface.sensor_width_px, cols), 0, 65536);
  surface.sensor_height_px = std::clamp(std::max(surface.sensor_height_px, rows), 0, 65536);
  // A hostile comment must not make a grid of gigabytes out of a small file.
  if (static_cast<std::size_t>(surface.sensor_width_px) * static_cast<std::size_t>(surface.sensor_height_px) >
      std::size_t{400} << 20) {
    surface.sensor_width_px = cols;
    surface.sensor_height_px = rows;
  }
}

}  // namespace

Result<Surface> DecodePly(std::span<const std::uint8_t> bytes) {
  auto header = detail::ReadPlyHeader(bytes);
  if (!header) return Fail(header.error());
  PlyReader reader(*header, bytes.subspan(header->size_bytes));
  Surface surface;
  ReadComments(*header, surface);
  for (const PlyElement& element : header->elements) {
    // Every row takes at least a byte, so a count beyond the file is a lie that must not be reserved for.
    if (element.count > bytes.size()) return Fail(ErrorCode::kBadFile, "the PLY is shorter than its header says");
    Status read;
    if (element.name == "vertex") {
      read = ReadVertices(reader, element, surface);
    } else if (element.name == "face") {
      read = ReadFaces(reader, element, surface);
    } else {
      read = reader.Skip(element) ? Status{} : Fail(ErrorCode::kBadFile, "the PLY ends within '" + element.name + "'");
    }
    if (!read) return Fail(read.error());
  }
  if (surface.point_in_camera.empty()) return Fail(ErrorCode::kBadFile, "the PLY holds no vertex");
  SettleSensorSize(surface);
  return surface;
}

}  // namespace striae
