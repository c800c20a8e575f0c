#include "analysis/wound/detail/bed.h"

#include <cmath>
#include <limits>
#include <utility>

namespace striae::wound {
namespace {

using Mask = std::vector<std::uint8_t>;

// Quads (by their first cell) whose four corners are there and whose centre lies within the margin.
Mask QuadsWithin(const Scene& scene, double margin_mm) {
  const Patch& patch = scene.patch;
  Mask quad(patch.size(), 0);
  for (int j = 0; j + 1 < patch.height; ++j) {
    for (int i = 0; i + 1 < patch.width; ++i) {
      const double sum = scene.place[patch.At(i, j)].distance + scene.place[patch.At(i + 1, j)].distance +
                         scene.place[patch.At(i, j + 1)].distance + scene.place[patch.At(i + 1, j + 1)].distance;
      quad[patch.At(i, j)] = sum / 4 < margin_mm ? 1 : 0;  // infinite where a corner is missing
    }
  }
  return quad;
}

// Two quads that touch in a corner only would make the mesh non-manifold: fill (at first) or cut until none is left.
void JoinCorners(const Scene& scene, Mask& quad) {
  const Patch& patch = scene.patch;
  const auto possible = [&](int i, int j) {
    return std::isfinite(scene.place[patch.At(i, j)].distance) &&
           std::isfinite(scene.place[patch.At(i + 1, j)].distance) &&
           std::isfinite(scene.place[patch.At(i, j + 1)].distance) &&
           std::isfinite(scene.place[patch.At(i + 1, j + 1)].distance);
  };
  bool changed = true;
  for (int round = 0; changed; ++round) {
    changed = false;
    const bool may_fill = round < 20;  // cutting alone always ends
    for (int j = 0; j + 2 < patch.height; ++j) {
      for (int i = 0; i + 2 < patch.width; ++i) {
        auto& a = quad[patch.At(i, j)];
        auto& b = quad[patch.At(i + 1, j)];
        auto& c = quad[patch.At(i, j + 1)];
        auto& d = quad[patch.At(i + 1, j + 1)];
        if (a != d || b != c || a == b) continue;
        const bool set = a != 0;  // else b and c are
        auto& fill = set ? b : a;
        auto& cut = set ? a : b;
        if (may_fill && possible(set ? i + 1 : i, j)) {
          fill = 1;
        } else {
          cut = 0;
        }
        changed = true;
      }
    }
  }
}

void KeepLargestPart(const Patch& patch, Mask& quad) {
  std::vector<std::size_t> best;
  Mask seen(quad.size(), 0);
  const auto width = static_cast<std::size_t>(patch.width);
  for (std::size_t start = 0; start < quad.size(); ++start) {
    if (quad[start] == 0 || seen[start] != 0) continue;
    std::vector<std::size_t> part = {start};
    seen[start] = 1;
    for (std::size_t k = 0; k < part.size(); ++k) {
      // Quads never lie in the last row or column, so that steps cannot wrap around a filled row's end.
      for (const std::size_t next : {part[k] - 1, part[k] + 1, part[k] - width, part[k] + width}) {
        if (next >= quad.size() || quad[next] == 0 || seen[next] != 0) continue;
        seen[next] = 1;
        part.push_back(next);
      }
    }
    if (part.size() > best.size()) best = std::move(part);
  }
  std::fill(quad.begin(), quad.end(), std::uint8_t{0});
  for (const auto q : best) quad[q] = 1;
}

}  // namespace

Bed TakeBed(const Scene& scene, double margin_mm) {
  const Patch& patch = scene.patch;
  Mask quad = QuadsWithin(scene, margin_mm);
  JoinCorners(scene, quad);
  KeepLargestPart(patch, quad);
  Bed bed;
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> index(patch.size(), kNone);
  const auto vertex = [&](int i, int j) {
    const std::size_t cell = patch.At(i, j);
    if (index[cell] == kNone) {
      index[cell] = static_cast<std::uint32_t>(bed.cell.size());
      bed.cell.push_back(cell);
      bed.point.push_back(scene.local[cell]);
      bed.distance.push_back(scene.place[cell].distance);
    }
    return index[cell];
  };
  for (int j = 0; j + 1 < patch.height; ++j) {
    for (int i = 0; i + 1 < patch.width; ++i) {
      if (quad[patch.At(i, j)] == 0) continue;
      const auto a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i, j + 1), d = vertex(i + 1, j + 1);
      bed.triangles.push_back({a, c, b});  // rows grow downwards: counter-clockwise seen from the camera
      bed.triangles.push_back({b, c, d});
    }
  }
  return bed;
}

double SignedPlaneArea(const Bed& bed, const std::array<std::uint32_t, 3>& t) {
  const Eigen::Vector3d ab = bed.point[t[1]] - bed.point[t[0]], ac = bed.point[t[2]] - bed.point[t[0]];
  return (ab.x() * ac.y() - ab.y() * ac.x()) / 2;
}

std::vector<double> HeightsAbove(const Bed& bed, const Skin& skin) {
  std::vector<double> height(bed.point.size());
  for (std::size_t k = 0; k < height.size(); ++k) {
    const auto& p = bed.point[k];
    height[k] = skin.Height(p.x(), p.y()) - p.z();
  }
  return height;
}

double PrismSum(const Bed& bed, const std::vector<double>& height) {
  double volume = 0;
  for (const auto& t : bed.triangles) {
    volume += SignedPlaneArea(bed, t) * (height[t[0]] + height[t[1]] + height[t[2]]) / 3;
  }
  return volume;
}

SheetPair MakeSheets(const Bed& bed, const Skin& skin) {
  SheetPair pair{bed.point, bed.point, bed.triangles};
  for (auto& p : pair.skin) p.z() = skin.Height(p.x(), p.y());
  return pair;
}

}  // namespace striae::wound
