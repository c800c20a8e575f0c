#include "analysis/wound/detail/polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace striae::wound {

PolygonField::PolygonField(const Polygon& polygon) : start_{0} {
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Eigen::Vector2d& a = polygon[k];
    const Eigen::Vector2d side = polygon[(k + 1) % polygon.size()] - a;
    const double length2 = side.squaredNorm();
    sides_.push_back({a.x(), a.y(), side.x(), side.y(), length2 > 0 ? 1 / length2 : 0});
    start_.push_back(start_.back() + std::sqrt(length2));
  }
}

PolygonPlace PolygonField::At(const Eigen::Vector2d& point) const {
  double best = std::numeric_limits<double>::infinity(), share = 0;
  std::size_t nearest = 0;
  bool inside = false;
  for (std::size_t k = 0; k < sides_.size(); ++k) {
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
