#include "tests/support/depth_map.h"

#include <algorithm>
#include <cstring>
#include <random>
#include <stdexcept>
#include <vector>

#include "core/optics.h"
#include "tests/support/files.h"

namespace striae::testing {
namespace {

template <typename T>
T At(const std::vector<std::uint8_t>& bytes, std::size_t offset) {
  if (offset + sizeof(T) > bytes.size()) throw std::runtime_error("depth map is truncated");
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

struct Layout {
  std::uint32_t width = 0, height = 0, compression = 0;
  std::uint32_t rows_per_strip = 0, strips = 0;
  std::size_t strips_at = 0;  ///< where the strips' offsets stand
};

Layout ReadLayout(const std::vector<std::uint8_t>& bytes) {
  if (At<std::uint32_t>(bytes, 0) != 0x002A4949) throw std::runtime_error("not a little-endian TIFF");
  const auto directory = At<std::uint32_t>(bytes, 4);
  Layout layout;
  for (std::uint32_t i = 0; i < At<std::uint16_t>(bytes, directory); ++i) {
    const std::size_t entry = directory + 2 + std::size_t{12} * i;
    const bool is_short = At<std::uint16_t>(bytes, entry + 2) == 3;
    const std::uint32_t value = is_short ? At<std::uint16_t>(bytes, entry + 8) : At<std::uint32_t>(bytes, entry + 8);
    switch (At<std::uint16_t>(bytes, entry)) {
      case 256:
        layout.width = value;
        break;
      case 257:
        layout.height = value;
        break;
      case 259:
        layout.compression = value;
        break;
      case 273:
        layout.strips = At<std::uint32_t>(bytes, entry + 4);
        layout.strips_at = layout.strips == 1 ? entry + 8 : value;
        break;
      case 278:
        layout.rows_per_strip = value;
        break;
      default:
        break;
    }
  }
  if (layout.compression != 1) throw std::runtime_error("depth map is compressed");
  return layout;
}

}  // namespace

ImageF ReadDepthMap(const std::filesystem::path& path) {
  const auto bytes = ReadBytes(path);
  const Layout layout = ReadLayout(bytes);
  ImageF depth(static_cast<int>(layout.width), static_cast<int>(layout.height));
  for (std::uint32_t strip = 0; strip < layout.strips; ++strip) {
    const auto at = At<std::uint32_t>(bytes, layout.strips_at + std::size_t{4} * strip);
    const std::uint32_t first = strip * layout.rows_per_strip;
    for (std::uint32_t row = first; row < std::min(layout.height, first + layout.rows_per_strip); ++row) {
      for (std::uint32_t col = 0; col < layout.width; ++col) {
        depth(static_cast<int>(col), static_cast<int>(row)) =
            At<float>(bytes, at + 4 * (std::size_t{row - first} * layout.width + col));
      }
    }
  }
  return depth;
}

Surface SurfaceFromDepthMap(const std::filesystem::path& path, const CameraModel& camera, double noise_mm,
                            std::uint32_t seed) {
  const ImageF depth = ReadDepthMap(path);
  Surface surface;
  surface.sensor_width_px = depth.width();
  surface.sensor_height_px = depth.height();
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (int row = 0; row < depth.height(); ++row) {
    for (int col = 0; col < depth.width(); ++col) {
      if (!(depth(col, row) > 0)) continue;
      const Eigen::Vector3d ray = RayOf(camera, {kDepthMapStep_px * col, kDepthMapStep_px * row});
      surface.point_in_camera.push_back((ray * (depth(col, row) + noise_mm * normal(random))).cast<float>());
      surface.col.push_back(static_cast<std::uint16_t>(col));
      surface.row.push_back(static_cast<std::uint16_t>(row));
    }
  }
  return surface;
}

}  // namespace striae::testing
