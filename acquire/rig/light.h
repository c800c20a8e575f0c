// The flash through the grating: how bright the projector's light is at a point.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/calibration.h"

namespace striae::rig {

struct LightOptions {
  double ambient = 0.012;          ///< linear sensor value of a white body under room light alone
  double flash = 1.35;             ///< of a white body facing the bright stripes at `reference_mm`
  double reference_mm = 1000;      ///< distance from the projector for `flash`
  double leak = 0.02;              ///< share of the light that the grating's chromium lets through
  double blur_stripes = 0.09;      ///< standard deviation of the projector's focus blur
  double mask_aspect = 8.8 / 6.6;  ///< width of the grating's mask over its height
};

/// Share of the flash's light that a Ronchi grating of `stripes` stripes passes at stripe order n: stripe k is clear
/// from k - 0.25 to k + 0.25, its edges blurred by a Gaussian. Tabulated once.
class GratingLight {
 public:
  GratingLight(int stripes, double blur_stripes);
  [[nodiscard]] double At(double order) const;

 private:
  int stripes_;
  std::vector<double> table_;  ///< one stripe and its blurred surroundings
};

/// Fall-off with distance, edge of the mask across the stripes, and the projector lens' vignetting.
class ProjectorLight {
 public:
  ProjectorLight(const Calibration& calibration, int stripes, const LightOptions& options);
  /// Linear sensor value of a white body at the point that faces the light, before the grating.
  [[nodiscard]] double At(const Eigen::Vector3d& point_in_camera) const;

 private:
  Eigen::Matrix3d projector_from_camera_;
  Eigen::Vector3d center_mm_;
  double focal_stripes_, k1_, half_width_stripes_, half_height_stripes_, blur_stripes_, strength_mm2_;
};

/// The rig's stripes; a calibration that leaves them out (null) is lit by `otherwise`.
int StripesOf(const Calibration& calibration, int otherwise = 140);

}  // namespace striae::rig
