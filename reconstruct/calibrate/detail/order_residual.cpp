#include "reconstruct/calibrate/detail/order_residual.h"

#include <algorithm>

namespace striae::reconstruct::detail {
namespace {
constexpr int kMeetIterations = 25;
constexpr double kMeetTolerance_mm = 1e-9;
}  // namespace

ReferenceShape::Height HeightOrBase(const ReferenceShape& shape, double x, double y) {
  if (const auto height = shape.At(x, y)) return *height;
  return {shape.highest().z(), 0, 0, false};
}

double MeetRelief(const ReferenceShape& shape, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                  std::optional<double> start) {
  double t = start ? *start : (shape.highest().z() - origin.z()) / direction.z();
  for (int i = 0; i < kMeetIterations; ++i) {
    const Eigen::Vector3d p = origin + t * direction;
    const auto h = HeightOrBase(shape, p.x(), p.y());
    const double slope = direction.z() - h.dz_dx * direction.x() - h.dz_dy * direction.y();
    // Where the relief is nearly seen edge-on, Newton would leap; the plain fixed point is slower and safe.
    const double step = (h.z - p.z()) / (slope > 0.3 * direction.z() ? slope : direction.z());
    t += step;
    if (std::abs(step) < kMeetTolerance_mm) break;
  }
  return t;
}

}  // namespace striae::reconstruct::detail
