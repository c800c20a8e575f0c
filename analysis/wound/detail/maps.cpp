#include "analysis/wound/detail/maps.h"

#include <cmath>
#include <limits>

namespace striae::wound {
namespace {

constexpr double kStep_mm = 0.5;

// The bed's height at a place of the plane: the mean of the cells within one cell of it; NaN where there is none.
double BedAt(const Scene& scene, const Eigen::Vector2d& at) {
  const double reach = scene.patch.cell_mm();
  double sum = 0, count = 0;
  for (std::size_t c = 0; c < scene.local.size(); ++c) {
    if (!std::isfinite(scene.place[c].distance)) continue;
    const Eigen::Vector3d& p = scene.local[c];
    if (std::abs(p.x() - at.x()) > reach || std::abs(p.y() - at.y()) > reach) continue;
    sum += p.z();
    ++count;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

WoundSection Cut(const Scene& scene, const Skin& skin, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  WoundSection section;
  const double length = (to - from).norm();
  const int steps = std::max(1, static_cast<int>(length / kStep_mm));
  for (int k = 0; k <= steps; ++k) {
    const Eigen::Vector2d at = from + (to - from) * k / steps;
    section.along_mm.push_back(length * k / steps);
    section.skin_mm.push_back(skin.Height(at.x(), at.y()));
    section.bed_mm.push_back(BedAt(scene, at));
  }
  return section;
}

}  // namespace

WoundMaps DrawMaps(const Scene& scene, const Skin& skin, const Boundary& boundary, double reach_mm, double beyond_mm) {
  const Patch& patch = scene.patch;
  WoundMaps maps;
  maps.cell_px = patch.bin_px;
  maps.col0_px = patch.col0_px;
  maps.row0_px = patch.row0_px;
  maps.cell_mm = patch.cell_mm();
  for (ImageF* image : {&maps.depth_mm, &maps.u_mm, &maps.v_mm, &maps.bed_mm, &maps.skin_mm}) {
    *image = ImageF(patch.width, patch.height, std::numeric_limits<float>::quiet_NaN());
  }
  for (int j = 0; j < patch.height; ++j) {
    for (int i = 0; i < patch.width; ++i) {
      const std::size_t c = patch.At(i, j);
      if (!(scene.place[c].distance <= reach_mm)) continue;
      const auto& p = scene.local[c];
      const double height = skin.Height(p.x(), p.y());
      maps.depth_mm(i, j) = static_cast<float>(height - p.z());
      maps.u_mm(i, j) = static_cast<float>(p.x());
      maps.v_mm(i, j) = static_cast<float>(p.y());
      maps.bed_mm(i, j) = static_cast<float>(p.z());
      maps.skin_mm(i, j) = static_cast<float>(height);
    }
  }
  for (const auto& p : scene.outline) maps.boundary_mm.emplace_back(p.x(), p.y(), skin.Height(p.x(), p.y()));
  const Eigen::Vector2d along = (boundary.axis_to - boundary.axis_from).normalized(), across(-along.y(), along.x());
  const Eigen::Vector2d middle = (boundary.axis_from + boundary.axis_to) / 2;
  const double half = boundary.width_mm / 2 + beyond_mm;
  maps.longest = Cut(scene, skin, boundary.axis_from - beyond_mm * along, boundary.axis_to + beyond_mm * along);
  maps.across = Cut(scene, skin, middle - half * across, middle + half * across);
  return maps;
}

}  // namespace striae::wound
