#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/head/detail/cloud.h"

namespace striae::head::detail {
namespace {

/// Median distance across the optical axis between neighbours along rows, mm; 0 without neighbours. Distances in space
/// would grow with the noise along the rays.
double Spacing(const Surface& s) {
  std::vector<float> distances;
  const std::size_t step = std::max<std::size_t>(1, s.size() / 20000);
  for (std::size_t i = 0; i + 1 < s.size(); i += step) {
    if (s.row[i] == s.row[i + 1] && s.col[i] + 1 == s.col[i + 1]) {
      distances.push_back((s.point_in_camera[i] - s.point_in_camera[i + 1]).head<2>().norm());
    }
  }
  if (distances.empty()) return 0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

struct Block {
  float nearest = std::numeric_limits<float>::infinity();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sd = 0;
  int count = 0;
};

float SdOf(const Surface& s, std::size_t i) {
  return s.uncertainty_mm.size() == s.size() ? s.uncertainty_mm[i] : kUnsaidSdMm;
}

Thinned ThinGrid(const Surface& s, int stride, double spacing_mm) {
  const int blocks_wide = s.sensor_width_px / stride + 1;
  const int blocks_high = s.sensor_height_px / stride + 1;
  std::vector<Block> blocks(static_cast<std::size_t>(blocks_wide) * static_cast<std::size_t>(blocks_high));
  const auto block_of = [&](std::size_t i) -> Block& {
    const int col = std::min<int>(s.col[i], s.sensor_width_px - 1) / stride;
    const int row = std::min<int>(s.row[i], s.sensor_height_px - 1) / stride;
    return blocks[static_cast<std::size_t>(row) * static_cast<std::size_t>(blocks_wide) +
                  static_cast<std::size_t>(col)];
  };
  for (std::size_t i = 0; i < s.size(); ++i) {
    Block& block = block_of(i);
    block.nearest = std::min(block.nearest, s.point_in_camera[i].z());
  }
  // Skin at 70 degrees of grazing spans 2.7 spacings in depth within a block; anything beyond is another surface.
  const float side = static_cast<float>(3 * spacing_mm);
  for (std::size_t i = 0; i < s.size(); ++i) {
    Block& block = block_of(i);
    if (s.point_in_camera[i].z() > block.nearest + side) continue;
    block.sum += s.point_in_camera[i].cast<double>();
    block.pixel += Eigen::Vector2d(s.col[i], s.row[i]);
    block.sd += SdOf(s, i);
    ++block.count;
  }
  Thinned thinned;
  for (const Block& block : blocks) {
    // A quarter of the block: fewer are the frayed edge of a region.
    if (block.count > 0 && 4 * block.count >= stride * stride) {
      thinned.point.push_back((block.sum / block.count).cast<float>());
      thinned.sd_mm.push_back(static_cast<float>(block.sd / block.count));
      thinned.pixel.push_back((block.pixel / block.count).cast<float>());
    }
  }
  return thinned;
}

Thinned ThinVoxels(const Surface& s, double spacing_mm) {
  using Key = std::array<int, 3>;
  std::vector<std::pair<Key, std::uint32_t>> keyed(s.size());
  for (std::uint32_t i = 0; i < keyed.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      keyed[i].first[static_cast<std::size_t>(k)] = static_cast<int>(std::floor(s.point_in_camera[i][k] / spacing_mm));
    }
    keyed[i].second = i;
  }
  std::sort(keyed.begin(), keyed.end());
  Thinned thinned;
  for (std::size_t begin = 0; begin < keyed.size();) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double sd = 0;
    std::size_t end = begin;
    for (; end < keyed.size() && keyed[end].first == keyed[begin].first; ++end) {
      sum += s.point_in_camera[keyed[end].second].cast<double>();
      sd += SdOf(s, keyed[end].second);
    }
    thinned.point.push_back((sum / static_cast<double>(end - begin)).cast<float>());
    thinned.sd_mm.push_back(static_cast<float>(sd / static_cast<double>(end - begin)));
    thinned.pixel.push_back(Eigen::Vector2f::Constant(std::numeric_limits<float>::quiet_NaN()));
    begin = end;
  }
  return thinned;
}

}  // namespace

Cloud Select(const Cloud& cloud, const std::vector<std::uint32_t>& indices) {
  Cloud selected;
  selected.point.reserve(indices.size());
  selected.normal.reserve(indices.size());
  selected.sd_mm.reserve(indices.size());
  selected.pixel.reserve(indices.size());
  for (const std::uint32_t i : indices) {
    selected.point.push_back(cloud.point[i]);
    selected.normal.push_back(cloud.normal[i]);
    selected.sd_mm.push_back(cloud.sd_mm[i]);
    selected.pixel.push_back(cloud.pixel[i]);
  }
  return selected;
}

Thinned Thin(const Surface& surface, double spacing_mm) {
  const double spacing = surface.HasGrid() ? Spacing(surface) : 0;
  if (spacing <= 0) return ThinVoxels(surface, spacing_mm);
  const int stride = std::max(1, static_cast<int>(std::lround(spacing_mm / spacing)));
  return ThinGrid(surface, stride, spacing_mm);
}

}  // namespace striae::head::detail
