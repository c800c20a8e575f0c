#include "reconstruct/sensor_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/vector.h"
#include "reconstruct/detail/extent.h"
#include "reconstruct/detail/parallel.h"
#include "reconstruct/detail/sensor_grid.h"

namespace striae::reconstruct {
namespace {

using detail::ParallelBlocks;
using detail::ParallelLines;
using detail::RowOfRays;
using Face = std::array<std::uint32_t, 3>;

constexpr float kSteepest = 3.7F;      // tan 75 degrees
constexpr float kNoiseStep_mm = 0.5F;  // neighbours may differ by this whatever the slope

/// Triangles of the squares between two rows, a bit each. With the corners
///   p00 p10
///   p01 p11: kUpperLeft p00 p01 p10, kLowerRight p10 p01 p11, kLowerLeft p00 p01 p11, kUpperRight p00 p11 p10.
enum : std::uint8_t { kUpperLeft = 1, kLowerRight = 2, kLowerLeft = 4, kUpperRight = 8 };

STRIAE_VECTORISED void TrianglesBetween(const float* __restrict a, const float* __restrict b, int squares,
                                        float steepest, std::uint8_t* __restrict kinds) {
  const auto joined = [=](float p, float q) {  // 0 for NaN
    return static_cast<int>(std::abs(p - q) < steepest * (p < q ? p : q) + kNoiseStep_mm);
  };
  for (int x = 0; x < squares; ++x) {
    const float z00 = a[x], z10 = a[x + 1], z01 = b[x], z11 = b[x + 1];
    const int top = joined(z00, z10), left = joined(z00, z01), right = joined(z10, z11), bottom = joined(z01, z11);
    const int diagonal = joined(z10, z01), other = joined(z00, z11);
    const int along = diagonal * ((top & left) * kUpperLeft | (right & bottom) * kLowerRight);
    const int across = other * ((left & bottom) * kLowerLeft | (top & right) * kUpperRight);
    kinds[x] = static_cast<std::uint8_t>(along != 0 ? along : across);
  }
}

STRIAE_VECTORISED std::size_t CountBits(const std::uint8_t* kinds, int squares) {
  std::uint32_t count = 0;
  for (int x = 0; x < squares; ++x) {
    const unsigned k = kinds[x];
    count += (k & 1U) + (k >> 1U & 1U) + (k >> 2U & 1U) + (k >> 3U);
  }
  return count;
}

STRIAE_VECTORISED std::size_t CountValid(const float* depth, int width) {
  std::uint32_t count = 0;
  for (int x = 0; x < width; ++x) count += depth[x] == depth[x] ? 1 : 0;
  return count;
}

/// Calls visit(vertex) for every point of a row.
template <typename Visit>
void ForEachPoint(const SensorSurface::Grid& grid, int row, RowOfRays& rays, const Visit& visit) {
  const PointImages& images = grid.images;
  const float *depth = images.depth.Row(row), *uncertainty = images.uncertainty.Row(row);
  const float* modulation = images.modulation.Row(row);
  const Rgb8* colour = images.colour.Row(row);
  const detail::Extent extent = detail::ExtentOf(depth, grid.width());
  grid.table.Row(row, extent.first, extent.last, rays);
  for (int col = extent.first; col < extent.last; ++col) {
    if (std::isnan(depth[col])) continue;
    const auto x = static_cast<std::size_t>(col);
    const auto z = static_cast<double>(depth[col]);
    visit(PlyVertex{{static_cast<float>(z * rays.x[x]), static_cast<float>(z * rays.y[x]), depth[col]},
                    colour[col],
                    modulation[col],
                    static_cast<std::uint16_t>(col),
                    static_cast<std::uint16_t>(row),
                    uncertainty[col]});
  }
}

/// Calls visit(corners) for every face between a row and the next; counter-clockwise seen from the camera, whose y
/// points down.
template <typename Visit>
void ForEachFace(const SensorSurface::Grid& grid, int row, const Visit& visit) {
  const auto at = static_cast<std::size_t>(row);
  const float *a = grid.images.depth.Row(row), *b = grid.images.depth.Row(row + 1);
  const std::uint8_t* kinds = grid.triangles.Row(row);
  auto i = static_cast<std::uint32_t>(grid.first_point[at]), j = static_cast<std::uint32_t>(grid.first_point[at + 1]);
  constexpr std::uint8_t kBoth = kUpperLeft | kLowerRight;
  const int squares = grid.width() - 1;
  for (int x = 0; x < squares; ++x) {
    for (; x < squares && kinds[x] == kBoth; ++x, ++i, ++j) {  // all four corners are there, square after square
      visit(Face{i, j, i + 1});
      visit(Face{i + 1, j, j + 1});
    }
    if (x == squares) break;
    const std::uint32_t p10 = i + (std::isnan(a[x]) ? 0U : 1U), p11 = j + (std::isnan(b[x]) ? 0U : 1U);
    const unsigned kind = kinds[x];
    if ((kind & kUpperLeft) != 0) visit(Face{i, j, p10});
    if ((kind & kLowerRight) != 0) visit(Face{p10, j, p11});
    if ((kind & kLowerLeft) != 0) visit(Face{i, j, p11});
    if ((kind & kUpperRight) != 0) visit(Face{i, p11, p10});
    i = p10;
    j = p11;
  }
}

/// starts[k] is the sum of counts before row k; the last is that of all.
std::vector<std::size_t> Starts(int rows, auto count_of) {
  std::vector<std::size_t> starts(static_cast<std::size_t>(rows) + 1, 0);
  ParallelLines(rows, [&](int row) { starts[static_cast<std::size_t>(row) + 1] = count_of(row); });
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  return starts;
}

/// The rows of a PLY, some at a time.
class Pieces {
 public:
  Pieces(const SensorSurface::Grid& grid, std::string header)
      : grid_(grid),
        header_(std::move(header)),
        of_points_(Count(grid.first_point)),
        of_faces_(Count(grid.first_face)) {}
  [[nodiscard]] int count() const { return 1 + of_points_ + of_faces_; }
  void Encode(int index, Buffer<std::uint8_t>& out) const {
    if (index == 0) {
      out.assign(header_.begin(), header_.end());
    } else if (index <= of_points_) {
      EncodePoints((index - 1) * kRows, out);
    } else {
      EncodeFaces((index - 1 - of_points_) * kRows, out);
    }
  }

 private:
  static constexpr int kRows = 8;  ///< at most about a megabyte: it stays in the cache until it is written
  static int Count(const std::vector<std::size_t>& starts) {
    return static_cast<int>(starts.size() - 1 + kRows - 1) / kRows;
  }
  /// Elements of the rows from `first` on, and the row behind them.
  static std::pair<std::size_t, int> Extent(const std::vector<std::size_t>& starts, int first) {
    const int last = std::min(first + kRows, static_cast<int>(starts.size()) - 1);
    return {starts[static_cast<std::size_t>(last)] - starts[static_cast<std::size_t>(first)], last};
  }

  void EncodePoints(int first, Buffer<std::uint8_t>& bytes) const {
    const auto [points, last] = Extent(grid_.first_point, first);
    bytes.resize(points * (kPlyVertexBytes + kPlyUncertaintyBytes));
    std::uint8_t* out = bytes.data();
    RowOfRays rays;
    for (int row = first; row < last && points > 0; ++row) {
      ForEachPoint(grid_, row, rays, [&](const PlyVertex& vertex) { out = PutPlyVertex(out, vertex, true); });
    }
  }
  void EncodeFaces(int first, Buffer<std::uint8_t>& bytes) const {
    const auto [faces, last] = Extent(grid_.first_face, first);
    bytes.resize(faces * kPlyFaceBytes);
    std::uint8_t* out = bytes.data();
    for (int row = first; row < last && faces > 0; ++row) {
      ForEachFace(grid_, row, [&](const Face& face) { out = PutPlyFace(out, face); });
    }
  }

  const SensorSurface::Grid& grid_;
  std::string header_;
  int of_points_, of_faces_;
};

}  // namespace

SensorSurface::Grid::Grid(PointImages of, const CameraModel& camera, detail::RayTable rays, bool with_faces)
    : images(std::move(of)), table(std::move(rays)) {
  first_point = Starts(height(), [this](int row) { return CountValid(images.depth.Row(row), width()); });
  if (!with_faces || height() < 2) {
    first_face.assign(1, 0);
    return;
  }
  const float steepest = kSteepest * static_cast<float>(1 / std::min(camera.fx, camera.fy));
  triangles = Image<std::uint8_t>::Unset(width(), height() - 1);
  first_face = Starts(height() - 1, [&](int row) {
    TrianglesBetween(images.depth.Row(row), images.depth.Row(row + 1), width() - 1, steepest, triangles.Row(row));
    return CountBits(triangles.Row(row), width() - 1);
  });
}

SensorSurface::SensorSurface() = default;
SensorSurface::SensorSurface(std::unique_ptr<Grid> grid) : grid_(std::move(grid)) {}
SensorSurface::SensorSurface(SensorSurface&&) noexcept = default;
SensorSurface& SensorSurface::operator=(SensorSurface&&) noexcept = default;
SensorSurface::~SensorSurface() = default;

const ImageF& SensorSurface::depth() const { return grid_->images.depth; }
std::size_t SensorSurface::points() const { return grid_ ? grid_->first_point.back() : 0; }
std::size_t SensorSurface::faces() const { return grid_ ? grid_->first_face.back() : 0; }

std::size_t SensorSurface::FileBytes() const {
  return points() * (kPlyVertexBytes + kPlyUncertaintyBytes) + faces() * kPlyFaceBytes;
}

Surface SensorSurface::ToSurface() && {
  Surface surface;
  surface.comments = std::move(comments);
  if (!grid_) return surface;
  const auto grid = std::move(grid_);
  surface.sensor_width_px = grid->width();
  surface.sensor_height_px = grid->height();
  const std::size_t count = grid->first_point.back();
  surface.point_in_camera.resize(count);
  surface.colour.resize(count);
  surface.quality.resize(count);
  surface.uncertainty_mm.resize(count);
  surface.col.resize(count);
  surface.row.resize(count);
  ParallelBlocks(grid->height(), [&](int, int first, int last) {
    RowOfRays rays;
    for (int row = first; row < last; ++row) {
      std::size_t at = grid->first_point[static_cast<std::size_t>(row)];
      ForEachPoint(*grid, row, rays, [&](const PlyVertex& vertex) {
        surface.point_in_camera[at] = vertex.point_in_camera;
        surface.colour[at] = vertex.colour;
        surface.quality[at] = vertex.quality;
        surface.uncertainty_mm[at] = vertex.uncertainty_mm;
        surface.col[at] = vertex.col;
        surface.row[at] = vertex.row;
        ++at;
      });
    }
  });
  grid->images.colour = {};  // makes room for the faces
  grid->images.modulation = grid->images.uncertainty = {};
  surface.faces.resize(grid->first_face.back());
  ParallelLines(static_cast<int>(grid->first_face.size()) - 1, [&](int row) {
    auto* next = surface.faces.data() + grid->first_face[static_cast<std::size_t>(row)];
    ForEachFace(*grid, row, [&](const Face& face) { *next++ = face; });
  });
  return surface;
}

bool SensorSurface::EncodePly(const PieceSink& sink) const {
  PlySummary summary;
  summary.vertices = points();
  summary.faces = faces();
  summary.comments = comments;
  summary.uncertainty = points() > 0;
  if (!grid_) return sink({});
  if (!grid_) {
    const std::string header = PlyHeaderOf(summary);
    return sink({reinterpret_cast<const std::uint8_t*>(header.data()), header.size()});
  }
  summary.sensor_width_px = grid_->width();
  summary.sensor_height_px = grid_->height();
  const Pieces pieces(*grid_, PlyHeaderOf(summary));
  return SendInOrder(
      pieces.count(), detail::ThreadCount(), [&](int index, Buffer<std::uint8_t>& out) { pieces.Encode(index, out); },
      sink);
}

}  // namespace striae::reconstruct
