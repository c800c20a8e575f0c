#include "analysis/wound/detail/polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace striae::wound {

PolygonField::PolygonField(const Polygon& polygon) : start_{0} {
  constexpr std::size_t kRun = 12;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Eigen::Vector2d& a = polygon[k];
    const Eigen::Vector2d side = polygon[(k + 1) % polygon.size()] - a;
    const double length2 = side.squaredNorm();
    sides_.push_back({a.x(), a.y(), side.x(), side.y(), length2 > 0 ? 1 / length2 : 0});
    start_.push_back(start_.back() + std::sqrt(length2));
  }
  for (std::size_t first = 0; first < polygon.size(); first += kRun) {
    const std::size_t last = std::min(first + kRun, polygon.size());
    Eigen::Vector2d low = polygon[first], high = low;
    for (std::size_t k = first; k <= last; ++k) {
      low = low.cwiseMin(polygon[k % polygon.size()]);
      high = high.cwiseMax(polygon[k % polygon.size()]);
    }
    const Eigen::Vector2d middle = (low + high) / 2;
    runs_.push_back({first, last, middle.x(), middle.y(), (high - low).norm() / 2, low.y(), high.y(), high.x()});
  }
}

PolygonPlace PolygonField::At(const Eigen::Vector2d& point) const {
  // No side of a run is nearer than its circle, and none further than the circle's far side.
  double bound = std::numeric_limits<double>::infinity();
  for (const Run& run : runs_) bound = std::min(bound, std::hypot(point.x() - run.x, point.y() - run.y) + run.radius);
  double best = std::numeric_limits<double>::infinity(), share = 0;
  std::size_t nearest = 0;
  bool inside = false;
  for (const Run& run : runs_) {
    const double rx = point.x() - run.x, ry = point.y() - run.y, reach = (bound + run.radius) * (1 + 1e-9);
    const bool near = rx * rx + ry * ry <= reach * reach;
    const bool beside = point.y() >= run.low_y && point.y() <= run.high_y && point.x() <= run.high_x;
    if (!near && !beside) continue;
    for (std::size_t k = run.first; k < run.last; ++k) {
      const Side& side = sides_[k];
      const double x = point.x() - side.x, y = point.y() - side.y;
      const double t = std::min(1.0, std::max(0.0, (x * side.dx + y * side.dy) * side.per_length2));
      const double off_x = x - t * side.dx, off_y = y - t * side.dy;
      const double distance2 = off_x * off_x + off_y * off_y;
      if (distance2 < best) {
        best = distance2;
        share = t;
        nearest = k;
      }
      // The side crosses the point's row, and does so to its right.
      if ((y < 0) != (y < side.dy) && (x < y / side.dy * side.dx)) inside = !inside;
    }
  }
  const double along = start_[nearest] + share * (start_[nearest + 1] - start_[nearest]);
  return {inside ? -std::sqrt(best) : std::sqrt(best), perimeter() > 0 ? along / perimeter() : 0};
}

double EnclosedArea(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const auto& a = polygon[k];
    const auto& b = polygon[(k + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(twice) / 2;
}

Polygon Resample(const Polygon& polygon, double step) {
  double perimeter = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) perimeter += (polygon[(k + 1) % polygon.size()] - polygon[k]).norm();
  const auto count = static_cast<std::size_t>(std::max(8L, std::lround(perimeter / step)));
  Polygon result;
  std::size_t side = 0;
  double before = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const double target = perimeter * static_cast<double>(n) / static_cast<double>(count);
    double length = (polygon[(side + 1) % polygon.size()] - polygon[side]).norm();
    while (side + 1 < polygon.size() && before + length < target) {
      before += length;
      ++side;
      length = (polygon[(side + 1) % polygon.size()] - polygon[side]).norm();
    }
    const double t = length > 0 ? std::min(1.0, (target - before) / length) : 0.0;
    result.push_back(polygon[side] + t * (polygon[(side + 1) % polygon.size()] - polygon[side]));
  }
  return result;
}

std::vector<double> RowCrossings(const Polygon& polygon, double y) {
  std::vector<double> crossings;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const auto& a = polygon[k];
    const auto& b = polygon[(k + 1) % polygon.size()];
    if ((a.y() > y) != (b.y() > y)) crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
  }
  std::sort(crossings.begin(), crossings.end());
  return crossings;
}

}  // namespace striae::wound
