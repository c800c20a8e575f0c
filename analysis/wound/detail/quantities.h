// Depths of a wound's bed below a virtual skin, and the lengths of its boundary on it.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/wound/detail/bed.h"

namespace striae::wound {

/// Distance of a point below the skin from it along the skin's own normal, mm; negative above it.
double NormalDepth(const Skin& skin, const Eigen::Vector3d& p);

/// Height of the skin above the surface over all cells within `reach_mm` of the outline, Gaussian-smoothed by sd
/// `smoothing_mm` (over what is there). Cells elsewhere are 0 and must not be asked.
std::vector<double> SmoothedHeights(const Scene& scene, const Skin& skin, double smoothing_mm, double reach_mm);

struct Depths {
  double max_mm = 0, p95_mm = 0;  ///< along the skin's normal, on smoothed heights, inside the outline
  Eigen::Vector2d deepest = Eigen::Vector2d::Zero();  ///< where, in the frame's plane
  double proud_mm3 = 0;      ///< tissue above the skin by more than the threshold, inside the outline
  double proud_all_mm3 = 0;  ///< the same with the margin
  double bed_area_mm2 = 0;   ///< of the smoothed bed inside the outline
  double bridged_mm3 = 0;    ///< volume under the skin over triangles that touch a filled cell
};
Depths MeasureDepths(const Scene& scene, const Bed& bed, const Skin& skin, const std::vector<double>& smoothed,
                     double proud_threshold_mm);

struct Boundary {
  double area_mm2 = 0;        ///< of the skin inside the outline
  double plane_area_mm2 = 0;  ///< of the outline in the frame's plane
  double perimeter_mm = 0;    ///< of the outline draped on the skin
  double length_mm = 0;       ///< longest chord of the draped outline
  Eigen::Vector2d axis_from = Eigen::Vector2d::Zero(), axis_to = Eigen::Vector2d::Zero();  ///< of that chord
  double width_mm = 0;  ///< extent across it, in the plane of the chord and the skin's tangents
};
/// `smoothing_mm`: of the line before its lengths are taken, which a shaking hand makes longer; its area is as drawn.
Boundary MeasureBoundary(const Polygon& outline, const Skin& skin, double step_mm, double cell_mm, double smoothing_mm);

}  // namespace striae::wound
