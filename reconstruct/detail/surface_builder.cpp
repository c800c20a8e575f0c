#include "reconstruct/detail/surface_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "core/optics.h"
#include "core/vector.h"
#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kSteepest = 3.7F;      // tan 75 degrees
constexpr float kNoiseStep_mm = 0.5F;  // neighbours may differ by this whatever the slope

STRIAE_VECTORISED void KeepWithin(const double* depth_mm, const double* per_stripe, std::size_t count, double near_mm,
                                  double far_mm, float* depth, float* uncertainty) {
  for (std::size_t i = 0; i < count; ++i) {
    uncertainty[i] *= static_cast<float>(std::abs(per_stripe[i]));
    depth[i] = (depth_mm[i] >= near_mm) & (depth_mm[i] <= far_mm) ? static_cast<float>(depth_mm[i]) : kNone;
  }
}

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

class Builder {
 public:
  Builder(const PointImages& images, const Calibration& calibration, const RayTable& table)
      : images_(images),
        table_(table),
        width_(images.depth.width()),
        height_(images.depth.height()),
        steepest_(kSteepest * static_cast<float>(1 / std::min(calibration.camera.fx, calibration.camera.fy))) {
    surface.sensor_width_px = width_;
    surface.sensor_height_px = height_;
  }

  void Points() {
    starts_.assign(static_cast<std::size_t>(height_) + 1, 0);
    ParallelLines(height_, [&](int row) {
      starts_[static_cast<std::size_t>(row) + 1] = CountValid(images_.depth.Row(row), width_);
    });
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    const std::size_t count = starts_.back();
    surface.point_in_camera.resize(count);
    surface.colour.resize(count);
    surface.quality.resize(count);
    surface.uncertainty_mm.resize(count);
    surface.col.resize(count);
    surface.row.resize(count);
    ParallelBlocks(height_, [&](int, int first, int last) {
      RowOfRays rays;
      for (int row = first; row < last; ++row) {
        if (starts_[static_cast<std::size_t>(row) + 1] != starts_[static_cast<std::size_t>(row)]) FillRow(row, rays);
      }
    });
  }

  /// Counted before they are written: collected row by row they would be in memory twice.
  void Faces() {
    std::vector<std::size_t> starts(static_cast<std::size_t>(height_) + 1, 0);
    ForEachRow([&](int row, const std::uint8_t* kinds) {
      starts[static_cast<std::size_t>(row) + 1] = CountBits(kinds, width_ - 1);
    });
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    surface.faces.resize(starts.back());
    ForEachRow([&](int row, const std::uint8_t* kinds) {
      if (starts[static_cast<std::size_t>(row)] == starts[static_cast<std::size_t>(row) + 1]) return;
      WriteFaces(row, kinds, surface.faces.data() + starts[static_cast<std::size_t>(row)]);
    });
  }

  Surface surface;

 private:
  void FillRow(int row, RowOfRays& rays) {
    table_.Row(row, rays);
    const float* depth = images_.depth.Row(row);
    const float *uncertainty = images_.uncertainty.Row(row), *modulation = images_.modulation.Row(row);
    const Rgb8* colour = images_.colour.Row(row);
    std::size_t at = starts_[static_cast<std::size_t>(row)];
    for (int col = 0; col < width_; ++col) {
      if (std::isnan(depth[col])) continue;
      const auto x = static_cast<std::size_t>(col);
      const auto z = static_cast<double>(depth[col]);
      surface.point_in_camera[at] = {static_cast<float>(z * rays.x[x]), static_cast<float>(z * rays.y[x]), depth[col]};
      surface.colour[at] = colour[col];
      surface.quality[at] = modulation[col];
      surface.uncertainty_mm[at] = uncertainty[col];
      surface.col[at] = static_cast<std::uint16_t>(col);
      surface.row[at] = static_cast<std::uint16_t>(row);
      ++at;
    }
  }

  template <typename Visit>
  void ForEachRow(const Visit& visit) const {
    ParallelBlocks(height_ - 1, [&](int, int first, int last) {
      std::vector<std::uint8_t> kinds(static_cast<std::size_t>(width_));
      for (int row = first; row < last; ++row) {
        TrianglesBetween(images_.depth.Row(row), images_.depth.Row(row + 1), width_ - 1, steepest_, kinds.data());
        visit(row, kinds.data());
      }
    });
  }

  /// Counter-clockwise seen from the camera, whose y points down.
  void WriteFaces(int row, const std::uint8_t* kinds, std::array<std::uint32_t, 3>* next) const {
    const float *a = images_.depth.Row(row), *b = images_.depth.Row(row + 1);
    auto i = static_cast<std::uint32_t>(starts_[static_cast<std::size_t>(row)]);
    auto j = static_cast<std::uint32_t>(starts_[static_cast<std::size_t>(row) + 1]);
    for (int x = 0; x + 1 < width_; ++x) {
      const std::uint32_t p00 = i, p01 = j;
      const std::uint32_t p10 = i + (std::isnan(a[x]) ? 0U : 1U), p11 = j + (std::isnan(b[x]) ? 0U : 1U);
      const unsigned kind = kinds[x];
      if (kind == (kUpperLeft | kLowerRight)) {
        *next++ = {p00, p01, p10};
        *next++ = {p10, p01, p11};
      } else if (kind != 0) {
        if ((kind & kUpperLeft) != 0) *next++ = {p00, p01, p10};
        if ((kind & kLowerRight) != 0) *next++ = {p10, p01, p11};
        if ((kind & kLowerLeft) != 0) *next++ = {p00, p01, p11};
        if ((kind & kUpperRight) != 0) *next++ = {p00, p11, p10};
      }
      i = p10;
      j = p11;
    }
  }

  const PointImages& images_;
  const RayTable& table_;
  int width_, height_;
  float steepest_;
  std::vector<std::size_t> starts_;  ///< first point of every row
};

}  // namespace

ImageF Triangulate(ImageF order, const Calibration& calibration, const RayTable& table, double near_mm, double far_mm,
                   ImageF& uncertainty) {
  const StripeOptics optics(calibration);
  const auto width = static_cast<std::size_t>(order.width());
  ParallelBlocks(order.height(), [&](int, int first, int last) {
    RowOfRays rays;
    std::vector<double> depth(width), per_stripe(width);
    for (int row = first; row < last; ++row) {
      float* pixels = order.Row(row);
      // Only where the row has orders: most of a photograph is often background.
      const auto known = [](float n) { return !std::isnan(n); };
      const auto begin = static_cast<std::size_t>(std::find_if(pixels, pixels + width, known) - pixels);
      if (begin == width) continue;
      std::size_t end = width;
      while (!known(pixels[end - 1])) --end;
      table.Row(row, rays);
      optics.DepthsAt(end - begin, rays.x.data() + begin, rays.y.data() + begin, pixels + begin, depth.data(),
                      per_stripe.data());
      KeepWithin(depth.data(), per_stripe.data(), end - begin, near_mm, far_mm, pixels + begin,
                 uncertainty.Row(row) + begin);
    }
  });
  return order;
}

Surface BuildSurface(PointImages images, const Calibration& calibration, const RayTable& table, bool faces) {
  Builder builder(images, calibration, table);
  builder.Points();
  images.colour = {};  // makes room for the faces
  images.modulation = images.uncertainty = {};
  if (faces && images.depth.height() > 1) builder.Faces();
  return std::move(builder.surface);
}

}  // namespace striae::reconstruct::detail
