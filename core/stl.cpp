#include "core/stl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <unordered_map>

#include <Eigen/Geometry>

namespace striae {
namespace {

constexpr std::size_t kHeaderBytes = 80, kTriangleBytes = 50;

template <typename T>
std::uint8_t* Put(std::uint8_t* out, const T& value) {
  std::memcpy(out, &value, sizeof value);
  return out + sizeof value;
}

using Place = std::array<std::uint32_t, 3>;  ///< the bits of x, y, z

struct PlaceHash {
  std::size_t operator()(const Place& p) const {
    std::size_t hash = 0;
    for (const std::uint32_t v : p) hash = (hash ^ v) * 0x9E3779B97F4A7C15ULL;
    return hash ^ (hash >> 29);
  }
};

}  // namespace

std::vector<std::uint8_t> EncodeStl(const Surface& surface, std::string_view header) {
  std::vector<std::uint8_t> bytes(kHeaderBytes + 4 + surface.faces.size() * kTriangleBytes);
  const std::string text = (header.starts_with("solid") ? "STL " : "") + std::string(header);
  std::memcpy(bytes.data(), text.data(), std::min(text.size(), kHeaderBytes - 1));
  std::uint8_t* out = Put(bytes.data() + kHeaderBytes, static_cast<std::uint32_t>(surface.faces.size()));
  for (const auto& face : surface.faces) {
    const Eigen::Vector3f &a = surface.point_in_camera[face[0]], &b = surface.point_in_camera[face[1]],
                          &c = surface.point_in_camera[face[2]];
    const Eigen::Vector3f normal = (b - a).cross(c - a).normalized();
    for (const Eigen::Vector3f* v : {&normal, &a, &b, &c}) out = Put(Put(Put(out, v->x()), v->y()), v->z());
    out = Put(out, std::uint16_t{0});
  }
  return bytes;
}

Result<Surface> DecodeStl(std::span<const std::uint8_t> bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kHeaderBytes + 4) std::memcpy(&count, bytes.data() + kHeaderBytes, 4);
  if (count == 0 || bytes.size() != kHeaderBytes + 4 + std::size_t{count} * kTriangleBytes) {
    return Fail(ErrorCode::kBadFile, "not a binary STL, or it is truncated: its size is not that of its triangles");
  }
  Surface surface;
  std::unordered_map<Place, std::uint32_t, PlaceHash> known;
  known.reserve(count / 2 + 3);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint8_t* in = bytes.data() + kHeaderBytes + 4 + std::size_t{i} * kTriangleBytes + 12;
    std::array<std::uint32_t, 3> face{};
    for (std::uint32_t& corner : face) {
      Eigen::Vector3f point;
      std::memcpy(point.data(), in, 12);
      in += 12;
      if (!point.allFinite()) {
        return Fail(ErrorCode::kBadFile, "triangle " + std::to_string(i) + " of the STL is not finite");
      }
      const Eigen::Vector3f placed = point.array() + 0.0F;  // -0 and 0 are one place
      const Place place = std::bit_cast<Place>(std::array<float, 3>{placed.x(), placed.y(), placed.z()});
      const auto [at, fresh] = known.try_emplace(place, static_cast<std::uint32_t>(surface.size()));
      if (fresh) surface.point_in_camera.push_back(placed);
      corner = at->second;
    }
    surface.faces.push_back(face);
  }
  surface.colour.assign(surface.size(), Rgb8{200, 200, 200});
  surface.quality.assign(surface.size(), 1.0F);
  return surface;
}

}  // namespace striae
