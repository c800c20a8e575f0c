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
  double blur_stripes = 0.09;      ///< standard deviation of the projector's blur in focus (lens errors, diffraction)
  double aperture_mm = 0;          ///< diameter of the projector lens' pupil; 0: the grating is as sharp everywhere
  double focus_mm = 1000;          ///< distance from the projector where the grating is sharp
  double mask_aspect = 8.8 / 6.6;  ///< width of the grating's mask over its height
};

/// Share of the flash's light that a Ronchi grating of `stripes` stripes passes at stripe order n: stripe k is clear
/// from k - 0.25 to k + 0.25, its edges blurred by a Gaussian. Tabulated once.
class GratingLight {
 public:
  explicit GratingLight(int stripes);
  /// `blur_stripes` is the Gaussian's standard deviation; above half a stripe nothing of the stripes is left anyway.
  [[nodiscard]] double At(double order, double blur_stripes) const;

 private:
  [[nodiscard]] double Table(std::size_t level, double place) const;
  int stripes_;
  std::vector<double> stripe_;  ///< one stripe and its blurred surroundings, for one level of blur after the other
};

/// Standard deviation of the grating's image at a point `distance_mm` from the projector, stripes: the blur in focus
/// and the pupil's image, a disc of aperture * focal_stripes * |1/distance - 1/focus| stripes, a quarter of which is
/// its standard deviation along one direction.
double GratingBlur(const LightOptions& options, double focal_stripes, double distance_mm);

/// Fall-off with distance, edge of the mask across the stripes, and the projector lens' vignetting.
class ProjectorLight {
 public:
  ProjectorLight(const Calibration& calibration, int stripes, const LightOptions& options);
  /// Linear sensor value of a white body at the point that faces the light, before the grating.
  [[nodiscard]] double At(const Eigen::Vector3d& point_in_camera) const;
  /// Standard deviation of the grating's image there, stripes.
  [[nodiscard]] double BlurAt(const Eigen::Vector3d& point_in_camera) const;

 private:
  LightOptions options_;
  Eigen::Matrix3d projector_from_camera_;
  Eigen::Vector3d center_mm_;
  double focal_stripes_, k1_, half_width_stripes_, half_height_stripes_, strength_mm2_;
};

/// The rig's stripes; a calibration that leaves them out (null) is lit by `otherwise`.
int StripesOf(const Calibration& calibration, int otherwise = 140);

}  // namespace striae::rig
