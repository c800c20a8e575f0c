// Plane polygons in the wound's frame (mm) or on the sensor (px).
#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

namespace striae::wound {

using Polygon = std::vector<Eigen::Vector2d>;

struct PolygonPlace {
  double distance = 0;  ///< to the nearest side; negative inside
  double along = 0;     ///< 0..1 of the perimeter, of the nearest point
};

/// Signed distance queries (what a measurement spends most of its time on: hence sides in runs of neighbours, of which
/// most are too far away to be looked at).
class PolygonField {
 public:
  explicit PolygonField(const Polygon& polygon);
  [[nodiscard]] PolygonPlace At(const Eigen::Vector2d& point) const;
  [[nodiscard]] double perimeter() const { return start_.back(); }

 private:
  struct Side {
    double x, y, dx, dy, per_length2;  ///< from its first point; 1 / length^2, 0 for a side without length
  };
  /// Consecutive sides with the circle and the box around them.
  struct Run {
    std::size_t first, last;
    double x, y, radius;
    double low_y, high_y, high_x;
  };
  std::vector<Side> sides_;
  std::vector<Run> runs_;
  std::vector<double> start_;  ///< arc length at each vertex, and the whole perimeter last
};

/// Absolute enclosed area.
double EnclosedArea(const Polygon& polygon);
/// The same line with points at equal steps of about `step` (at least 8 of them).
Polygon Resample(const Polygon& polygon, double step);

/// Calls visit(point, area) over midpoints of a fine partition of the polygon: rows of height about `step`, each cut
/// exactly at the polygon's sides.
template <typename Visit>
void IntegrateOver(const Polygon& polygon, double step, Visit visit);

/// Crossings of the horizontal line y with the polygon, ascending.
std::vector<double> RowCrossings(const Polygon& polygon, double y);

template <typename Visit>
void IntegrateOver(const Polygon& polygon, double step, Visit visit) {
  double low = polygon.front().y(), high = low;
  for (const auto& p : polygon) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  const int rows = std::max(1, static_cast<int>((high - low) / step + 1));
  const double row_height = (high - low) / rows;
  for (int r = 0; r < rows; ++r) {
    const double y = low + (r + 0.5) * row_height;
    const std::vector<double> x = RowCrossings(polygon, y);
    for (std::size_t k = 0; k + 1 < x.size(); k += 2) {
      const int pieces = std::max(1, static_cast<int>((x[k + 1] - x[k]) / step + 1));
      const double piece = (x[k + 1] - x[k]) / pieces;
      for (int p = 0; p < pieces; ++p) visit(Eigen::Vector2d(x[k] + (p + 0.5) * piece, y), piece * row_height);
    }
  }
}

}  // namespace striae::wound
