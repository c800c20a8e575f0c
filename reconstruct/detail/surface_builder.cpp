#include "reconstruct/detail/surface_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>

#include "core/optics.h"
#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kSteepest = 3.7;      // tan 75 degrees
constexpr double kNoiseStep_mm = 0.5;  // neighbours may differ by this whatever the slope

/// Index of the first point of every row.
std::vector<std::uint32_t> RowStarts(const ImageF& depth) {
  std::vector<std::uint32_t> starts(static_cast<std::size_t>(depth.height()) + 1, 0);
  for (int row = 0; row < depth.height(); ++row) {
    const float* z = depth.Row(row);
    const auto valid = std::count_if(z, z + depth.width(), [](float v) { return !std::isnan(v); });
    starts[static_cast<std::size_t>(row) + 1] =
        starts[static_cast<std::size_t>(row)] + static_cast<std::uint32_t>(valid);
  }
  return starts;
}

/// Triangles between two neighbouring rows: add(corner, corner, corner).
template <typename Add>
void MeshRows(const ImageF& depth, int row, std::uint32_t start, std::uint32_t start_below, double pitch_per_mm,
              const Add& add) {
  const float *a = depth.Row(row), *b = depth.Row(row + 1);
  const auto joined = [&](float p, float q) {
    return std::abs(p - q) < kSteepest * pitch_per_mm * std::min(p, q) + kNoiseStep_mm;  // false for NaN
  };
  std::uint32_t i = start, j = start_below;  // of (x, row) and (x, row + 1)
  for (int x = 0; x + 1 < depth.width(); ++x) {
    const bool va = !std::isnan(a[x]), vb = !std::isnan(b[x]);
    const std::uint32_t p00 = i, p01 = j, p10 = i + (va ? 1U : 0U), p11 = j + (vb ? 1U : 0U);
    const float z00 = a[x], z10 = a[x + 1], z01 = b[x], z11 = b[x + 1];
    const bool diagonal = joined(z10, z01), other = joined(z00, z11);
    const bool top = joined(z00, z10), left = joined(z00, z01), right = joined(z10, z11), bottom = joined(z01, z11);
    // Counter-clockwise seen from the camera, whose y points down.
    if (diagonal && ((top && left) || (right && bottom))) {
      if (top && left) add(p00, p01, p10);
      if (right && bottom) add(p10, p01, p11);
    } else if (other) {
      if (left && bottom) add(p00, p01, p11);
      if (top && right) add(p00, p11, p10);
    }
    i = p10;
    j = p11;
  }
}

}  // namespace

ImageF Triangulate(ImageF order, const Calibration& calibration, const RayTable& table, double near_mm, double far_mm) {
  const StripeOptics optics(calibration);
  ParallelBlocks(order.height(), [&](int, int first, int last) {
    std::vector<Eigen::Vector2d> rays;
    for (int row = first; row < last; ++row) {
      table.Row(row, rays);
      float* pixel = order.Row(row);
      for (const Eigen::Vector2d& ray : rays) {
        float& at = *pixel++;
        if (std::isnan(at)) continue;
        const auto z = optics.DepthAt(ray.homogeneous(), at);
        at = z && *z >= near_mm && *z <= far_mm ? static_cast<float>(*z) : kNone;
      }
    }
  });
  return order;
}

Surface BuildSurface(const ImageF& depth, ImageRgb colour, ImageF modulation, const Calibration& calibration,
                     const RayTable& table, bool faces) {
  Surface surface;
  surface.sensor_width_px = depth.width();
  surface.sensor_height_px = depth.height();
  const std::vector<std::uint32_t> starts = RowStarts(depth);
  const std::size_t count = starts.back();
  surface.point_in_camera.resize(count);
  surface.colour.resize(count);
  surface.quality.resize(count);
  surface.col.resize(count);
  surface.row.resize(count);
  std::vector<std::size_t> face_starts(static_cast<std::size_t>(depth.height()) + 1, 0);
  const auto mesh_row = [&](int row, const auto& add) {
    MeshRows(depth, row, starts[static_cast<std::size_t>(row)], starts[static_cast<std::size_t>(row) + 1],
             1 / std::min(calibration.camera.fx, calibration.camera.fy), add);
  };
  const auto fill_row = [&](int row, std::vector<Eigen::Vector2d>& rays) {
    table.Row(row, rays);
    std::size_t at = starts[static_cast<std::size_t>(row)];
    for (int col = 0; col < depth.width(); ++col) {
      if (std::isnan(depth(col, row))) continue;
      const Eigen::Vector3d ray = rays[static_cast<std::size_t>(col)].homogeneous();
      surface.point_in_camera[at] = (static_cast<double>(depth(col, row)) * ray).cast<float>();
      surface.colour[at] = colour(col, row);
      surface.quality[at] = modulation(col, row);
      surface.col[at] = static_cast<std::uint16_t>(col);
      surface.row[at] = static_cast<std::uint16_t>(row);
      ++at;
    }
    if (faces && row + 1 < depth.height()) {
      std::size_t& number = face_starts[static_cast<std::size_t>(row) + 1];
      mesh_row(row, [&](std::uint32_t, std::uint32_t, std::uint32_t) { ++number; });
    }
  };
  ParallelBlocks(depth.height(), [&](int, int first, int last) {
    std::vector<Eigen::Vector2d> rays;
    for (int row = first; row < last; ++row) fill_row(row, rays);
  });
  colour = {};  // makes room for the faces
  modulation = {};
  // Counted before they are written: collected row by row they would be in memory twice.
  std::partial_sum(face_starts.begin(), face_starts.end(), face_starts.begin());
  surface.faces.resize(face_starts.back());
  ParallelLines(faces ? depth.height() - 1 : 0, [&](int row) {
    auto* next = surface.faces.data() + face_starts[static_cast<std::size_t>(row)];
    mesh_row(row, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) { *next++ = {a, b, c}; });
  });
  return surface;
}

}  // namespace striae::reconstruct::detail
