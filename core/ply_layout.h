// How Striae lays out a PLY: for whoever writes one without having it in memory as a whole.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/buffer.h"
#include "core/image.h"

namespace striae {

/// What the header says.
struct PlySummary {
  int sensor_width_px = 0, sensor_height_px = 0;
  std::size_t vertices = 0, faces = 0;
  bool uncertainty = true;  ///< a property of its own, last
  std::vector<std::string> comments;
};

std::string PlyHeaderOf(const PlySummary& summary);

struct PlyVertex {
  Eigen::Vector3f point_in_camera;  ///< mm
  Rgb8 colour;
  float quality = 0;
  std::uint16_t col = 0, row = 0;
  float uncertainty_mm = 0;
};

inline constexpr std::size_t kPlyVertexBytes = 3 * 4 + 3 + 4 + 2 * 2, kPlyUncertaintyBytes = 4;
inline constexpr std::size_t kPlyFaceBytes = 1 + 3 * 4;

namespace detail {

template <typename T>
std::uint8_t* Put(std::uint8_t* out, const T& value) {
  static_assert(std::endian::native == std::endian::little, "values are copied as they stand");
  std::memcpy(out, &value, sizeof value);
  return out + sizeof value;
}

}  // namespace detail

/// Both return the place behind what they wrote.
inline std::uint8_t* PutPlyVertex(std::uint8_t* out, const PlyVertex& vertex, bool uncertainty) {
  static_assert(sizeof(Rgb8) == 3, "copied as it stands");
  // Value by value: what has just been put together from parts is slow to read back as a whole.
  for (const float value : {vertex.point_in_camera.x(), vertex.point_in_camera.y(), vertex.point_in_camera.z()}) {
    out = detail::Put(out, value);
  }
  out = detail::Put(detail::Put(out, vertex.colour), vertex.quality);
  out = detail::Put(detail::Put(out, vertex.col), vertex.row);
  return uncertainty ? detail::Put(out, vertex.uncertainty_mm) : out;
}
inline std::uint8_t* PutPlyFace(std::uint8_t* out, const std::array<std::uint32_t, 3>& corners) {
  out = detail::Put(out, std::uint8_t{3});
  return detail::Put(detail::Put(detail::Put(out, corners[0]), corners[1]), corners[2]);
}

/// Takes the next bytes of a file; false when they cannot be taken.
using PieceSink = std::function<bool(std::span<const std::uint8_t>)>;

/// Hands `count` pieces to `sink` in their order, one at a time, while `threads` threads (at least one) encode the next
/// ones: nothing as large as the file is ever in memory. `sink` is called from any of them. False as soon as `sink` is.
bool SendInOrder(int count, int threads, const std::function<void(int index, Buffer<std::uint8_t>& out)>& encode,
                 const PieceSink& sink);

}  // namespace striae
