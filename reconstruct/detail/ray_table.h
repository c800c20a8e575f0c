// The rays of all pixels, without undoing the lens distortion for each by itself.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/calibration.h"
#include "core/image.h"

namespace striae::reconstruct::detail {

/// Ray directions (x/z, y/z) on a grid of the sensor, linear in between. The grid is made so fine that the error stays
/// below 2e-5 px at the sensor's corners, where the distortion bends most.
class RayTable {
 public:
  RayTable(const CameraModel& camera, int width, int height);
  /// Rays (z = 1) of every pixel of a row; resizes `rays` to the sensor's width.
  void Row(int row, std::vector<Eigen::Vector2d>& rays) const;

 private:
  void Fill(const CameraModel& camera);
  [[nodiscard]] double ErrorAtCorners(const CameraModel& camera) const;
  [[nodiscard]] Eigen::Vector2d At(double col, double row) const;

  int width_, height_, step_ = 16;
  Image<Eigen::Vector2d> nodes_;
};

}  // namespace striae::reconstruct::detail
