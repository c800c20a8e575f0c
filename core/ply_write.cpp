#include <algorithm>
#include <atomic>
#include <string>
#include <thread>

#include "core/detail/ply_header.h"
#include "core/ply.h"
#include "core/ply_layout.h"

namespace striae {
namespace {

bool HasUncertainty(const Surface& surface) {
  return surface.size() > 0 && surface.uncertainty_mm.size() == surface.size();
}

PlySummary SummaryOf(const Surface& surface) {
  return {surface.sensor_width_px, surface.sensor_height_px, surface.size(),
          surface.faces.size(),    HasUncertainty(surface),  surface.comments};
}

/// The file cut into pieces that can be encoded one by one: the header, then so many vertices or faces each.
class PlyPieces {
 public:
  explicit PlyPieces(const Surface& surface)
      : surface_(surface),
        header_(PlyHeaderOf(SummaryOf(surface))),
        vertex_bytes_(kPlyVertexBytes + (HasUncertainty(surface) ? kPlyUncertaintyBytes : 0)),
        vertex_pieces_(Pieces(surface.size())),
        face_pieces_(Pieces(surface.faces.size())) {}

  [[nodiscard]] int count() const { return static_cast<int>(1 + vertex_pieces_ + face_pieces_); }
  [[nodiscard]] std::size_t TotalBytes() const {
    return header_.size() + surface_.size() * vertex_bytes_ + surface_.faces.size() * kPlyFaceBytes;
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
  static constexpr std::size_t kElements = 32768;
  static std::size_t Pieces(std::size_t elements) { return (elements + kElements - 1) / kElements; }

  void EncodeVertices(std::size_t first, Buffer<std::uint8_t>& bytes) const {
    const std::size_t last = std::min(first + kElements, surface_.size());
    const bool gridded = surface_.HasGrid(), doubted = vertex_bytes_ > kPlyVertexBytes;
    const bool coloured = surface_.colour.size() == surface_.size();
    const bool weighted = surface_.quality.size() == surface_.size();
    bytes.resize((last - first) * vertex_bytes_);
    std::uint8_t* out = bytes.data();
    PlyVertex vertex;
    if (!coloured) vertex.colour = detail::kUnsaidColour;
    if (!weighted) vertex.quality = detail::kUnsaidQuality;
    for (std::size_t i = first; i < last; ++i) {
      vertex.point_in_camera = surface_.point_in_camera[i];
      if (coloured) vertex.colour = surface_.colour[i];
      if (weighted) vertex.quality = surface_.quality[i];
      if (gridded) {
        vertex.col = surface_.col[i];
        vertex.row = surface_.row[i];
      }
      if (doubted) vertex.uncertainty_mm = surface_.uncertainty_mm[i];
      out = PutPlyVertex(out, vertex, doubted);
    }
  }
  void EncodeFaces(std::size_t first, Buffer<std::uint8_t>& bytes) const {
    const std::size_t last = std::min(first + kElements, surface_.faces.size());
    bytes.resize((last - first) * kPlyFaceBytes);
    std::uint8_t* out = bytes.data();
    for (std::size_t i = first; i < last; ++i) out = PutPlyFace(out, surface_.faces[i]);
  }

  const Surface& surface_;
  std::string header_;
  std::size_t vertex_bytes_, vertex_pieces_, face_pieces_;
};

}  // namespace

std::string PlyHeaderOf(const PlySummary& summary) {
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  header += "comment " + std::string(detail::kSensorComment) + std::to_string(summary.sensor_width_px) + " " +
            std::to_string(summary.sensor_height_px) + "\n";
  header += "comment units mm, camera frame: x right, y down, z forward\n";
  for (const std::string& comment : summary.comments) header += "comment " + comment + "\n";
  header += "element vertex " + std::to_string(summary.vertices) + "\n";
  header +=
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property float quality\nproperty ushort col\nproperty ushort row\n";
  if (summary.uncertainty) header += "property float uncertainty\n";
  header += "element face " + std::to_string(summary.faces) + "\n";
  return header + "property list uchar uint vertex_indices\nend_header\n";
}

bool SendInOrder(int count, int threads, const std::function<void(int, Buffer<std::uint8_t>&)>& encode,
                 const PieceSink& sink) {
  std::atomic<int> next{0}, turn{0};
  std::atomic<bool> good{true};
  const auto work = [&] {
    Buffer<std::uint8_t> piece;
    for (int i = next.fetch_add(1); i < count; i = next.fetch_add(1)) {
      if (good.load()) encode(i, piece);
      for (int now = turn.load(); now != i; now = turn.load()) turn.wait(now);
      if (good.load() && !sink(piece)) good.store(false);
      turn.store(i + 1);
      turn.notify_all();
    }
  };
  std::vector<std::thread> others;
  for (int k = 1; k < std::min(threads, count); ++k) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  return good.load();
}

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

bool EncodePly(const Surface& surface, const PieceSink& sink) {
  const PlyPieces pieces(surface);
  const int count = pieces.count();
  const int threads = count > 2 ? 2 : 1;  // a small surface is not worth a thread
  return SendInOrder(
      count, threads, [&](int index, Buffer<std::uint8_t>& out) { pieces.Encode(index, out); }, sink);
}

}  // namespace striae
