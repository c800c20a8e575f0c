// A wound's bed as a triangulated disc, and the volume between it and a virtual skin.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "analysis/wound/detail/closed_volume.h"
#include "analysis/wound/detail/ring.h"

namespace striae::wound {

/// The measured surface inside the outline and a margin around it, as a triangulated disc of grid cells.
struct Bed {
  std::vector<std::size_t> cell;       ///< patch cell of every bed point
  std::vector<Eigen::Vector3d> point;  ///< wound frame, unsmoothed
  std::vector<double> distance;        ///< to the outline, negative inside
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Cells within `margin_mm` outside the outline; corner-touching parts are joined, separate specks dropped.
Bed TakeBed(const Scene& scene, double margin_mm);

/// Area of a triangle of it in the frame's plane, mm2; negative where it is folded over.
double SignedPlaneArea(const Bed& bed, const std::array<std::uint32_t, 3>& triangle);

/// Height of the skin above the bed at each bed point, along w.
std::vector<double> HeightsAbove(const Bed& bed, const Skin& skin);
/// Sum of vertical prisms, mm3: the same as VolumeBetween, but cheap (for many skins in turn).
double PrismSum(const Bed& bed, const std::vector<double>& height);
/// Bed and skin for CGAL.
SheetPair MakeSheets(const Bed& bed, const Skin& skin);

}  // namespace striae::wound
