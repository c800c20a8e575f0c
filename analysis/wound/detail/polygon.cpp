#include "analysis/wound/detail/polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace striae::wound {

PolygonField::PolygonField(Polygon polygon) : polygon_(std::move(polygon)), start_{0} {
  for (std::size_t k = 0; k < polygon_.size(); ++k) {
    start_.push_back(start_.back() + (polygon_[(k + 1) % polygon_.size()] - polygon_[k]).norm());
  }
}

PolygonPlace PolygonField::At(const Eigen::Vector2d& point) const {
  double best = std::numeric_limits<double>::infinity(), along = 0;
  bool inside = false;
  for (std::size_t k = 0; k < polygon_.size(); ++k) {
    const Eigen::Vector2d& a = polygon_[k];
    const Eigen::Vector2d& b = polygon_[k + 1 < polygon_.size() ? k + 1 : 0];
    const Eigen::Vector2d side = b - a, offset = point - a;
    const double length2 = side.squaredNorm();
    const double t = length2 > 0 ? std::clamp(offset.dot(side) / length2, 0.0, 1.0) : 0.0;
    const double distance2 = (offset - t * side).squaredNorm();
    if (distance2 < best) {
      best = distance2;
      along = start_[k] + t * (start_[k + 1] - start_[k]);
    }
    if ((a.y() > point.y()) != (b.y() > point.y()) &&
        point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
      inside = !inside;
    }
  }
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
