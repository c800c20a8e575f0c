#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <string>
#include <thread>

#include "core/detail/ply_header.h"
#include "core/ply.h"

namespace striae {
namespace {

static_assert(std::endian::native == std::endian::little, "values are copied as they stand");
static_assert(sizeof(Rgb8) == 3 && sizeof(std::array<std::uint32_t, 3>) == 12, "copied as they stand");

constexpr std::size_t kVertexBytes = 3 * 4 + 3 + 4 + 2 * 2, kUncertaintyBytes = 4;
constexpr std::size_t kFaceBytes = 1 + 3 * 4;

template <typename T>
std::uint8_t* Put(std::uint8_t* out, const T& value) {
  std::memcpy(out, &value, sizeof value);
  return out + sizeof value;
}

bool HasUncertainty(const Surface& surface) {
  return surface.size() > 0 && surface.uncertainty_mm.size() == surface.size();
}

std::string HeaderOf(const Surface& surface) {
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  header += "comment " + std::string(detail::kSensorComment) + std::to_string(surface.sensor_width_px) + " " +
            std::to_string(surface.sensor_height_px) + "\n";
  header += "comment units mm, camera frame: x right, y down, z forward\n";
  for (const std::string& comment : surface.comments) header += "comment " + comment + "\n";
  header += "element vertex " + std::to_string(surface.size()) + "\n";
  header +=
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property float quality\nproperty ushort col\nproperty ushort row\n";
  if (HasUncertainty(surface)) header += "property float uncertainty\n";
  header += "element face " + std::to_string(surface.faces.size()) + "\n";
  return header + "property list uchar uint vertex_indices\nend_header\n";
}

/// The file cut into pieces that can be encoded one by one: the header, then so many vertices or faces each.
class PlyPieces {
 public:
  explicit PlyPieces(const Surface& surface)
      : surface_(surface),
        header_(HeaderOf(surface)),
        vertex_bytes_(kVertexBytes + (HasUncertainty(surface) ? kUncertaintyBytes : 0)),
        vertex_pieces_(Pieces(surface.size())),
        face_pieces_(Pieces(surface.faces.size())) {}

  [[nodiscard]] int count() const { return static_cast<int>(1 + vertex_pieces_ + face_pieces_); }
  [[nodiscard]] std::size_t TotalBytes() const {
    return header_.size() + surface_.size() * vertex_bytes_ + surface_.faces.size() * kFaceBytes;
  }
  void Encode(int index, Buffer<std::uint8_t>& out) const {
    const auto piece = static_cast<std::size_t>(index);
    if (piece == 0) {
      out.assign(header_.begin(), header_.end());
    } else if (piece <= vertex_pieces_) {
      EncodeVertices((piece - 1) * kElements, out);
    } else {
      EncodeFaces((piece - 1 - vertex_pieces_) * kElements, out);
    }
  }

 private:
  static constexpr std::size_t kElements = 65536;
  static std::size_t Pieces(std::size_t elements) { return (elements + kElements - 1) / kElements; }

  void EncodeVertices(std::size_t first, Buffer<std::uint8_t>& bytes) const {
    const std::size_t last = std::min(first + kElements, surface_.size());
    const bool gridded = surface_.HasGrid(), doubted = vertex_bytes_ > kVertexBytes;
    bytes.resize((last - first) * vertex_bytes_);
    std::uint8_t* out = bytes.data();
    for (std::size_t i = first; i < last; ++i) {
      const Eigen::Vector3f& p = surface_.point_in_camera[i];
      out = Put(Put(Put(out, p.x()), p.y()), p.z());
      out = Put(out, surface_.colour[i]);
      out = Put(out, surface_.quality[i]);
      out = Put(out, gridded ? surface_.col[i] : std::uint16_t{0});
      out = Put(out, gridded ? surface_.row[i] : std::uint16_t{0});
      if (doubted) out = Put(out, surface_.uncertainty_mm[i]);
    }
  }
  void EncodeFaces(std::size_t first, Buffer<std::uint8_t>& bytes) const {
    const std::size_t last = std::min(first + kElements, surface_.faces.size());
    bytes.resize((last - first) * kFaceBytes);
    std::uint8_t* out = bytes.data();
    for (std::size_t i = first; i < last; ++i) out = Put(Put(out, std::uint8_t{3}), surface_.faces[i]);
  }

  const Surface& surface_;
  std::string header_;
  std::size_t vertex_bytes_, vertex_pieces_, face_pieces_;
};

}  // namespace

std::vector<std::uint8_t> EncodePly(const Surface& surface) {
  const PlyPieces pieces(surface);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(pieces.TotalBytes());
  EncodePly(surface, [&](std::span<const std::uint8_t> piece) {
    bytes.insert(bytes.end(), piece.begin(), piece.end());
    return true;
  });
  return bytes;
}

bool EncodePly(const Surface& surface, const std::function<bool(std::span<const std::uint8_t>)>& sink) {
  const PlyPieces pieces(surface);
  const int count = pieces.count();
  if (count <= 2) {  // a small surface is not worth a thread
    Buffer<std::uint8_t> buffer;
    for (int i = 0; i < count; ++i) {
      pieces.Encode(i, buffer);
      if (!sink(buffer)) return false;
    }
    return true;
  }
  constexpr int kStopped = -1;
  std::array<Buffer<std::uint8_t>, 2> buffers;
  std::atomic<int> encoded{0}, taken{0};
  std::thread encoder([&] {
    for (int i = 0; i < count; ++i) {
      for (int now = taken.load(); now != kStopped && i - now >= 2; now = taken.load()) taken.wait(now);
      if (taken.load() == kStopped) return;
      pieces.Encode(i, buffers[static_cast<std::size_t>(i % 2)]);
      encoded.store(i + 1);
      encoded.notify_one();
    }
  });
  bool good = true;
  for (int i = 0; i < count && good; ++i) {
    for (int now = encoded.load(); now <= i; now = encoded.load()) encoded.wait(now);
    good = sink(buffers[static_cast<std::size_t>(i % 2)]);
    taken.store(good ? i + 1 : kStopped);
    taken.notify_one();
  }
  encoder.join();
  return good;
}

}  // namespace striae
