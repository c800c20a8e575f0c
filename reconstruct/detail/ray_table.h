// The rays of all pixels, without undoing the lens distortion for each by itself.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/calibration.h"
#include "core/image.h"

namespace striae::reconstruct::detail {

/// The rays (x, y, 1) of a row of pixels.
struct RowOfRays {
  std::vector<double> x, y;
};

/// Ray directions (x/z, y/z) on a grid of the sensor, cubic (Lagrange) in between. The grid is made so fine that the
/// error stays below 2e-5 px at the sensor's corners, where the distortion bends most.
class RayTable {
 public:
  RayTable(const CameraModel& camera, int width, int height);
  /// Rays of the pixels [first, last) of a row, at their places (the others' are unset).
  void Row(int row, int first, int last, RowOfRays& rays) const;

 private:
  void Fill(const CameraModel& camera);
  [[nodiscard]] double ErrorAtCorners(const CameraModel& camera) const;

  int width_, height_, step_ = 64;
  Image<Eigen::Vector2d> nodes_;  ///< node (i, j) is the pixel ((i - 1) step, (j - 1) step)
};

}  // namespace striae::reconstruct::detail
