#include "reconstruct/detail/surface_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "core/optics.h"
#include "reconstruct/detail/parallel.h"
#include "reconstruct/detail/transpose.h"

namespace striae::reconstruct::detail {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kSteepest = 3.7;         // tan 75 degrees
constexpr double kNoiseStep_mm = 0.5;     // neighbours may differ by this whatever the slope
constexpr float kBrightHalfWidth = 0.1F;  // stripes around a bright centre that give the colour

struct Crest {
  int first = 0, last = 0;  ///< pixels within kBrightHalfWidth of a whole order
  float r = 0, g = 0, b = 0;
};

/// The bright centres along one line, in order.
std::vector<Crest> CrestsOf(const Rgb8* colour, const float* order, int length) {
  std::vector<Crest> crests;
  float whole_before = kNone;
  int count = 0;
  for (int x = 0; x < length; ++x) {
    const float whole = std::nearbyint(order[x]);
    if (std::isnan(order[x]) || std::abs(order[x] - whole) > kBrightHalfWidth) continue;
    if (crests.empty() || whole != whole_before || x - crests.back().last > 3) {
      crests.push_back({x, x, 0, 0, 0});
      count = 0;
    }
    whole_before = whole;
    Crest& crest = crests.back();
    crest.last = x;
    ++count;
    const auto mix = [&](float& mean, std::uint8_t value) {
      mean += (static_cast<float>(value) - mean) / static_cast<float>(count);
    };
    mix(crest.r, colour[x].r);
    mix(crest.g, colour[x].g);
    mix(crest.b, colour[x].b);
  }
  return crests;
}

void FillLine(const Rgb8* colour, const float* order, int length, Rgb8* out) {
  std::copy(colour, colour + length, out);
  const std::vector<Crest> crests = CrestsOf(colour, order, length);
  if (crests.empty()) return;
  const auto center = [](const Crest& c) { return 0.5F * static_cast<float>(c.first + c.last); };
  std::size_t next = 0;
  for (int x = 0; x < length; ++x) {
    if (std::isnan(order[x])) continue;
    const auto at = static_cast<float>(x);
    while (next < crests.size() && center(crests[next]) < at) ++next;
    const Crest& after = crests[std::min(next, crests.size() - 1)];
    const Crest& before = crests[next == 0 ? 0 : next - 1];
    const float span = center(after) - center(before);
    const float t = span > 0 ? std::clamp((at - center(before)) / span, 0.0F, 1.0F) : 0.0F;
    const auto blend = [t](float a, float b) { return static_cast<std::uint8_t>(a + t * (b - a) + 0.5F); };
    out[x] = {blend(before.r, after.r), blend(before.g, after.g), blend(before.b, after.b)};
  }
}

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

/// Triangles between two neighbouring rows.
void MeshRows(const ImageF& depth, int row, std::uint32_t start, std::uint32_t start_below, double pitch_per_mm,
              std::vector<std::array<std::uint32_t, 3>>& faces) {
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
      if (top && left) faces.push_back({p00, p01, p10});
      if (right && bottom) faces.push_back({p10, p01, p11});
    } else if (other) {
      if (left && bottom) faces.push_back({p00, p01, p11});
      if (top && right) faces.push_back({p00, p11, p10});
    }
    i = p10;
    j = p11;
  }
}

}  // namespace

ImageF Triangulate(const ImageF& order, const Calibration& calibration, const RayTable& table, double near_mm,
                   double far_mm) {
  const StripeOptics optics(calibration);
  ImageF depth(order.width(), order.height(), kNone);
  ParallelBlocks(order.height(), [&](int, int first, int last) {
    std::vector<Eigen::Vector2d> rays;
    for (int row = first; row < last; ++row) {
      table.Row(row, rays);
      for (int col = 0; col < order.width(); ++col) {
        if (std::isnan(order(col, row))) continue;
        const auto z = optics.DepthAt(rays[static_cast<std::size_t>(col)].homogeneous(), order(col, row));
        if (z && *z >= near_mm && *z <= far_mm) depth(col, row) = static_cast<float>(*z);
      }
    }
  });
  return depth;
}

ImageRgb ColourWithoutStripes(const ImageRgb& photograph, const ImageF& order, StripeDirection direction) {
  const bool horizontal = direction == StripeDirection::kHorizontal;
  const ImageRgb colour_lines = horizontal ? Transposed(photograph) : photograph;
  const ImageF order_lines = horizontal ? Transposed(order) : order;
  ImageRgb out(colour_lines.width(), colour_lines.height());
  ParallelLines(out.height(),
                [&](int line) { FillLine(colour_lines.Row(line), order_lines.Row(line), out.width(), out.Row(line)); });
  return horizontal ? Transposed(out) : out;
}

Surface BuildSurface(const ImageF& depth, const ImageRgb& colour, const ImageF& modulation,
                     const Calibration& calibration, const RayTable& table, bool faces) {
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
  std::vector<std::vector<std::array<std::uint32_t, 3>>> row_faces(static_cast<std::size_t>(depth.height()));
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
      MeshRows(depth, row, starts[static_cast<std::size_t>(row)], starts[static_cast<std::size_t>(row) + 1],
               1 / std::min(calibration.camera.fx, calibration.camera.fy), row_faces[static_cast<std::size_t>(row)]);
    }
  };
  ParallelBlocks(depth.height(), [&](int, int first, int last) {
    std::vector<Eigen::Vector2d> rays;
    for (int row = first; row < last; ++row) fill_row(row, rays);
  });
  for (const auto& list : row_faces) surface.faces.insert(surface.faces.end(), list.begin(), list.end());
  return surface;
}

}  // namespace striae::reconstruct::detail
