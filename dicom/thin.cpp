#include "dicom/thin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "dicom/detail/blocks.h"

namespace striae::dicom {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<std::uint32_t, 3>;
using detail::BlockFaces;
using detail::BlockMesh;

/// Distance from a point to a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
double DistanceToTriangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return ap.norm();
  if (d3 >= 0 && d4 <= d3) return bp.norm();
  if (d6 >= 0 && d5 <= d6) return cp.norm();
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).norm();
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).norm();
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return (bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)).norm();
  }
  const double sum = va + vb + vc;
  return (ap - vb / sum * ab - vc / sum * ac).norm();
}

/// True if pixel (x, y) within the block (0..step) lies in the triangle of these corners.
bool Covers(const std::array<std::array<int, 2>, 3>& corners, int x, int y) {
  const auto side = [&](int i, int j) {
    return (corners[j][0] - corners[i][0]) * (y - corners[i][1]) -
           (corners[j][1] - corners[i][1]) * (x - corners[i][0]);
  };
  const int s0 = side(0, 1), s1 = side(1, 2), s2 = side(2, 0);
  return (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
}

/// One coarse mesh: triangles of kept vertices (as full-resolution indices), and what was measured while making it.
struct Coarse {
  std::vector<Triangle> triangles;
  std::vector<float> deviation_mm;  ///< of every covered point, the smaller where two triangles meet; else NaN
};

Vector3d Point(const Surface& surface, std::uint32_t index) { return surface.point_in_camera[index].cast<double>(); }

/// Adds a triangle when its corners hang together, and measures the points under it.
void AddTriangle(const Surface& surface, const BlockMesh& block, const std::array<std::array<int, 2>, 3>& corners,
                 Coarse& coarse) {
  Triangle triangle{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto vertex = block.VertexAt(corners[i][0], corners[i][1]);
    if (!vertex || !block.SamePart(corners[0], corners[i])) return;
    triangle[i] = *vertex;
  }
  coarse.triangles.push_back(triangle);
  const Vector3d a = Point(surface, triangle[0]), b = Point(surface, triangle[1]), c = Point(surface, triangle[2]);
  for (int y = 0; y <= block.step(); ++y) {
    for (int x = 0; x <= block.step(); ++x) {
      const auto vertex = block.VertexAt(x, y);
      if (!vertex || !Covers(corners, x, y)) continue;
      const auto distance = static_cast<float>(DistanceToTriangle(Point(surface, *vertex), a, b, c));
      float& kept = coarse.deviation_mm[*vertex];
      kept = std::isnan(kept) ? distance : std::min(kept, distance);
    }
  }
}

Coarse MeshCoarsely(const Surface& surface, const Image<std::int32_t>& index, int step) {
  Coarse coarse;
  coarse.deviation_mm.assign(surface.size(), std::nanf(""));
  const BlockFaces faces(surface, step);
  BlockMesh block(surface, index, step);
  for (int by = 0; by < faces.rows(); ++by) {
    for (int bx = 0; bx < faces.columns(); ++bx) {
      const auto own = faces.Of(bx, by);
      if (own.empty()) continue;
      block.Load(bx, by, own);
      const std::array<int, 2> tl{0, 0}, tr{step, 0}, bl{0, step}, br{step, step};
      // Counter-clockwise seen from the camera, as in the full mesh. One diagonal as a rule; the other one where a
      // corner is missing, so that at most a triangle is lost there.
      if (block.VertexAt(0, 0) && block.VertexAt(step, step) &&
          (!block.VertexAt(step, 0) || !block.VertexAt(0, step))) {
        AddTriangle(surface, block, {tl, bl, br}, coarse);
        AddTriangle(surface, block, {tl, br, tr}, coarse);
      } else {
        AddTriangle(surface, block, {tl, bl, tr}, coarse);
        AddTriangle(surface, block, {tr, bl, br}, coarse);
      }
    }
  }
  return coarse;
}

/// The kept vertices in their old order, faces renumbered.
Surface Compact(const Surface& full, const std::vector<Triangle>& triangles) {
  std::vector<std::int64_t> kept(full.size(), -1);
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t vertex : triangle) kept[vertex] = 0;
  }
  Surface thin;
  thin.sensor_width_px = full.sensor_width_px;
  thin.sensor_height_px = full.sensor_height_px;
  thin.comments = full.comments;
  for (std::size_t i = 0; i < full.size(); ++i) {
    if (kept[i] < 0) continue;
    kept[i] = static_cast<std::int64_t>(thin.size());
    thin.point_in_camera.push_back(full.point_in_camera[i]);
    if (full.colour.size() == full.size()) thin.colour.push_back(full.colour[i]);
    if (full.quality.size() == full.size()) thin.quality.push_back(full.quality[i]);
    thin.col.push_back(full.col[i]);
    thin.row.push_back(full.row[i]);
  }
  for (const Triangle& triangle : triangles) {
    Triangle renumbered{};
    std::transform(triangle.begin(), triangle.end(), renumbered.begin(),
                   [&kept](std::uint32_t vertex) { return static_cast<std::uint32_t>(kept[vertex]); });
    thin.faces.push_back(renumbered);
  }
  return thin;
}

ThinnedSurface Finish(const Surface& full, const Coarse& coarse, int step) {
  ThinnedSurface thinned;
  thinned.step = step;
  std::size_t covered = 0;
  std::vector<float> left_out;
  for (std::size_t i = 0; i < full.size(); ++i) {
    if (std::isnan(coarse.deviation_mm[i])) continue;
    ++covered;
    if (full.col[i] % step != 0 || full.row[i] % step != 0) left_out.push_back(coarse.deviation_mm[i]);
  }
  thinned.uncovered_share = 1.0 - static_cast<double>(covered) / static_cast<double>(full.size());
  if (!left_out.empty()) {
    const auto at95 = left_out.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(left_out.size() - 1));
    std::nth_element(left_out.begin(), at95, left_out.end());
    thinned.deviation_p95_mm = *at95;
    thinned.deviation_max_mm = *std::max_element(at95, left_out.end());
  }
  thinned.surface = Compact(full, coarse.triangles);
  return thinned;
}

}  // namespace

Result<ThinnedSurface> ThinSurface(const Surface& surface, std::size_t most_faces) {
  if (surface.faces.empty()) {
    return Fail(ErrorCode::kMeasurementRefused,
                "the surface has no faces; reconstruct it with faces before the export");
  }
  if (surface.faces.size() <= most_faces) return ThinnedSurface{surface, 1, 0, 0, 0};
  if (!surface.HasGrid()) {
    return Fail(ErrorCode::kUsage, "the surface has " + std::to_string(surface.faces.size()) +
                                       " faces and does not say which sensor pixel each point is; use the surface that "
                                       "Striae reconstructed");
  }
  const Image<std::int32_t> index = VertexIndexGrid(surface);
  const double ratio =
      static_cast<double>(surface.faces.size()) / static_cast<double>(std::max<std::size_t>(1, most_faces));
  // Bridged pixels can leave a few faces more than the ratio says: then the next step.
  for (int step = std::max(2, static_cast<int>(std::ceil(std::sqrt(ratio))));; ++step) {
    const Coarse coarse = MeshCoarsely(surface, index, step);
    if (coarse.triangles.empty()) {
      return Fail(ErrorCode::kMeasurementRefused,
                  "the surface is too ragged to be thinned to " + std::to_string(most_faces) + " faces");
    }
    if (coarse.triangles.size() <= most_faces) return Finish(surface, coarse, step);
  }
}

}  // namespace striae::dicom
