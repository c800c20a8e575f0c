// Regions that unwrapping may have joined across a step of the surface.
#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "reconstruct/detail/order_joints.h"
#include "reconstruct/order.h"

namespace striae::reconstruct {
namespace {

using detail::Cell;
using detail::Eroded;
using detail::Grid;
using detail::Joiner;
using detail::kNone;
using detail::Parts;
using detail::SoundCells;
using detail::TakeOutBends;

constexpr double kNeck = 1.6;          ///< stripes from either side of a neck
constexpr double kLeastShare = 0.004;  ///< of all points: smaller parts are not split off

/// 1 for cells of a valley beside another part of the same region: both surfaces mix there.
Mask Seams(const Grid& grid, const Mask& sound, const Parts& parts) {
  Mask seam(grid.width, grid.height, 0);
  for (int row = 0; row < grid.height; ++row) {
    for (int col = 0; col < grid.width; ++col) {
      const std::int32_t own = parts.part(col, row);
      if (own == kNone || sound(col, row) != 0) continue;
      for (int y = std::max(0, row - 1); y <= std::min(grid.height - 1, row + 1); ++y) {
        for (int x = std::max(0, col - 1); x <= std::min(grid.width - 1, col + 1); ++x) {
          const std::int32_t p = parts.part(x, y);
          if (p != kNone && p != own && grid.region(x, y) == grid.region(col, row)) seam(col, row) = 1;
        }
      }
    }
  }
  return seam;
}

/// Gives every pixel its part's number (regions that stay whole keep theirs), takes out the seams, numbers by size.
std::vector<int> Relabel(const Grid& grid, const Parts& parts, const Mask& seam, PhaseResult& phase) {
  Unwrapped& unwrapped = phase.unwrapped;
  std::vector<int> origin(static_cast<std::size_t>(unwrapped.regions));
  std::iota(origin.begin(), origin.end(), 0);
  // The first part of a region keeps the region's number; the others get new ones.
  std::vector<std::int32_t> number(parts.parent.size(), kNone);
  std::vector<bool> split(origin.size(), false);
  for (const std::int32_t p : parts.part.pixels()) {
    if (p < 0 || number[static_cast<std::size_t>(p)] != kNone) continue;
    const auto region = static_cast<std::size_t>(parts.parent[static_cast<std::size_t>(p)]);
    number[static_cast<std::size_t>(p)] =
        split[region] ? static_cast<std::int32_t>(origin.size()) : parts.parent[static_cast<std::size_t>(p)];
    if (split[region]) origin.push_back(static_cast<int>(region));
    split[region] = true;
  }
  const auto part_of = [&](int x, int y, std::int32_t region) {
    const int col = std::min(x / grid.cell_x, grid.width - 1), row = std::min(y / grid.cell_y, grid.height - 1);
    for (const auto& [dx, dy] : {Cell(0, 0), Cell(1, 0), Cell(-1, 0), Cell(0, 1), Cell(0, -1), Cell(1, 1), Cell(-1, 1),
                                 Cell(1, -1), Cell(-1, -1)}) {
      if (!parts.part.Contains(col + dx, row + dy)) continue;
      const std::int32_t p = parts.part(col + dx, row + dy);
      if (p >= 0 && parts.parent[static_cast<std::size_t>(p)] == region) return number[static_cast<std::size_t>(p)];
    }
    return region;
  };
  const int width = phase.mask.width(), height = phase.mask.height();
  std::vector<std::vector<std::size_t>> counts(static_cast<std::size_t>(detail::ThreadCount()));
  detail::ParallelBlocks(height, [&](int thread, int first, int last) {
    auto& count = counts[static_cast<std::size_t>(thread)];
    count.resize(origin.size(), 0);
    for (int y = first; y < last; ++y) {
      std::int32_t* r = unwrapped.region.Row(y);
      for (int x = 0; x < width; ++x) {
        if (r[x] < 0) continue;
        if (split[static_cast<std::size_t>(r[x])]) {
          if (seam(std::min(x / grid.cell_x, grid.width - 1), std::min(y / grid.cell_y, grid.height - 1)) != 0) {
            r[x] = kNone;
            phase.mask(x, y) = 0;
            unwrapped.phase(x, y) = std::numeric_limits<float>::quiet_NaN();
            continue;
          }
          r[x] = part_of(x, y, r[x]);
        }
        ++count[static_cast<std::size_t>(r[x])];
      }
    }
  });
  std::vector<std::size_t> points(origin.size(), 0);
  for (const auto& count : counts) {
    for (std::size_t i = 0; i < count.size(); ++i) points[i] += count[i];
  }
  std::vector<std::size_t> by_size(origin.size());
  std::iota(by_size.begin(), by_size.end(), std::size_t{0});
  std::stable_sort(by_size.begin(), by_size.end(), [&](std::size_t a, std::size_t b) { return points[a] > points[b]; });
  std::vector<std::int32_t> rank(origin.size());
  std::vector<int> parents(origin.size());
  unwrapped.pixels.assign(origin.size(), 0);
  for (std::size_t i = 0; i < by_size.size(); ++i) {
    rank[by_size[i]] = static_cast<std::int32_t>(i);
    parents[i] = origin[by_size[i]];
    unwrapped.pixels[i] = points[by_size[i]];
  }
  detail::ParallelLines(height, [&](int y) {
    std::int32_t* r = unwrapped.region.Row(y);
    for (int x = 0; x < width; ++x) r[x] = r[x] < 0 ? kNone : rank[static_cast<std::size_t>(r[x])];
  });
  unwrapped.regions = static_cast<int>(origin.size());
  return parents;
}

}  // namespace

std::vector<int> SplitDoubtfulRegions(PhaseResult& phase) {
  std::vector<int> whole(static_cast<std::size_t>(phase.unwrapped.regions));
  std::iota(whole.begin(), whole.end(), 0);
  const Grid grid(phase);
  const double period = phase.carrier_period_px;
  if (grid.width < 3 || grid.height < 3) return whole;
  const bool horizontal = phase.direction == StripeDirection::kHorizontal;
  Mask sound = SoundCells(grid, grid.Cells(horizontal ? 1.0 : 1.5, period, grid.cell_x),
                          grid.Cells(horizontal ? 1.5 : 1.0, period, grid.cell_y));
  TakeOutBends(grid, grid.Cells(horizontal ? 0.66 : 1.0, period, grid.cell_x),
               grid.Cells(horizontal ? 1.0 : 0.66, period, grid.cell_y), sound);
  const Mask eroded =
      Eroded(grid, sound, grid.Cells(kNeck, period, grid.cell_x), grid.Cells(kNeck, period, grid.cell_y));
  Parts parts(grid, sound, eroded);
  parts.Grow();
  const auto points =
      std::count_if(grid.region.pixels().begin(), grid.region.pixels().end(), [](std::int32_t r) { return r >= 0; });
  if (!parts.KeepLarge(eroded, kLeastShare * static_cast<double>(points))) return whole;
  parts.Grow();
  Joiner(grid, phase, sound, parts).Join();
  return Relabel(grid, parts, Seams(grid, sound, parts), phase);
}

}  // namespace striae::reconstruct
