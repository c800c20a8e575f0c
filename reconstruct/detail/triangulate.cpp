#include "reconstruct/detail/triangulate.h"

#include <cmath>
#include <limits>
#include <vector>

#include "core/optics.h"
#include "core/vector.h"
#include "reconstruct/detail/extent.h"
#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

STRIAE_VECTORISED void KeepWithin(const double* depth_mm, const double* per_stripe, std::size_t count, double near_mm,
                                  double far_mm, float* depth, float* uncertainty) {
  for (std::size_t i = 0; i < count; ++i) {
    uncertainty[i] *= static_cast<float>(std::abs(per_stripe[i]));
    depth[i] = (depth_mm[i] >= near_mm) & (depth_mm[i] <= far_mm) ? static_cast<float>(depth_mm[i]) : kNone;
  }
}

}  // namespace

ImageF Triangulate(ImageF order, const Calibration& calibration, const RayTable& table, double near_mm, double far_mm,
                   ImageF& uncertainty) {
  const StripeOptics optics(calibration);
  const auto width = static_cast<std::size_t>(order.width());
  ParallelBlocks(order.height(), [&](int, int first, int last) {
    RowOfRays rays;
    std::vector<double> depth(width), per_stripe(width);
    for (int row = first; row < last; ++row) {
      float* pixels = order.Row(row);
      const Extent extent = ExtentOf(pixels, order.width());
      if (extent.empty()) continue;
      const auto begin = static_cast<std::size_t>(extent.first), end = static_cast<std::size_t>(extent.last);
      table.Row(row, extent.first, extent.last, rays);
      optics.DepthsAt(end - begin, rays.x.data() + begin, rays.y.data() + begin, pixels + begin, depth.data(),
                      per_stripe.data());
      KeepWithin(depth.data(), per_stripe.data(), end - begin, near_mm, far_mm, pixels + begin,
                 uncertainty.Row(row) + begin);
    }
  });
  return order;
}

}  // namespace striae::reconstruct::detail
