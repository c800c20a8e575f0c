#include "tests/head/depth_map.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <vector>

#include "core/optics.h"

namespace striae::testing {
namespace {

constexpr int kStep = 8;

template <typename T>
T At(const std::vector<char>& bytes, std::size_t offset) {
  if (offset + sizeof(T) > bytes.size()) throw std::runtime_error("depth map is truncated");
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

struct Layout {
  std::uint32_t width = 0, height = 0, compression = 0, offset = 0;
};

Layout ReadLayout(const std::vector<char>& bytes) {
  if (At<std::uint32_t>(bytes, 0) != 0x002A4949) throw std::runtime_error("not a little-endian TIFF");
  const auto directory = At<std::uint32_t>(bytes, 4);
  Layout layout;
  for (std::uint32_t i = 0; i < At<std::uint16_t>(bytes, directory); ++i) {
    const std::size_t entry = directory + 2 + 12 * i;
    const bool is_short = At<std::uint16_t>(bytes, entry + 2) == 3;
    const auto count = At<std::uint32_t>(bytes, entry + 4);
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
      // Strips follow one another in these files.
      case 273:
        layout.offset = count == 1 ? value : At<std::uint32_t>(bytes, value);
        break;
      default:
        break;
    }
  }
  if (layout.compression != 1) throw std::runtime_error("depth map is compressed");
  return layout;
}

}  // namespace

Surface SurfaceFromDepthMap(const std::filesystem::path& path, const CameraModel& camera, double noise_mm,
                            std::uint32_t seed) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  const Layout layout = ReadLayout(bytes);
  Surface s;
  s.sensor_width_px = static_cast<int>(layout.width);
  s.sensor_height_px = static_cast<int>(layout.height);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (std::uint32_t row = 0; row < layout.height; ++row) {
    for (std::uint32_t col = 0; col < layout.width; ++col) {
      const auto depth = At<float>(bytes, layout.offset + 4 * (std::size_t{row} * layout.width + col));
      if (!(depth > 0)) continue;
      const Eigen::Vector3d ray = RayOf(camera, {kStep * col, kStep * row});
      s.point_in_camera.push_back((ray * (depth + noise_mm * normal(random))).cast<float>());
      s.col.push_back(static_cast<std::uint16_t>(col));
      s.row.push_back(static_cast<std::uint16_t>(row));
    }
  }
  return s;
}

}  // namespace striae::testing
