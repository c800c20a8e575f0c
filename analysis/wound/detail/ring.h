// The ring of healthy skin around the outline: which cells belong to it, and whether they suffice.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "analysis/wound/detail/patch.h"
#include "analysis/wound/detail/polygon.h"
#include "analysis/wound/detail/skin.h"

namespace striae::wound {

/// A patch seen in the wound's frame: for every cell its place there and against the outline.
struct Scene {
  Patch patch;
  Frame frame;
  Polygon outline;                     ///< in the frame's plane, mm, points about 0.5 mm apart
  std::vector<std::uint8_t> sheet;     ///< healthy side of the boundary, connected without a jump
  std::vector<Eigen::Vector3d> local;  ///< mm
  std::vector<PolygonPlace> place;     ///< distance is infinite where a cell is missing or off the sheet
};

/// From here on rings are taken from large cells: their noise averages out, and small ones take time.
inline constexpr double kCoarseFrom_mm = 9;

struct Ring {
  double gap_mm = 0, width_mm = 0;
  std::vector<Eigen::Vector3d> points;  ///< wound frame; thinned
  std::vector<PolygonPlace> places;
  double coverage = 0;       ///< share of the ring's plane area that holds points
  double empty_sectors = 0;  ///< share of 36 equal parts of the boundary beside which less than 30 % is there
};

Ring TakeRing(const Scene& scene, double gap_mm, double width_mm);

/// Whether the ring's inner edge differs from its middle all around: mean difference (mm) and its t over 24 sectors.
struct RadialTrend {
  double step_mm = 0, t = 0;
};
RadialTrend FindRadialTrend(const Ring& ring, const Skin& skin);

/// Share of ring points where the skin slopes more than this against the ring's plane.
double SteepShare(const Ring& ring, const Skin& skin, double max_slope_deg);

}  // namespace striae::wound
