// Striped photographs computed from the geometry alone: a surface z(x, y), a rig, and the light of a Ronchi grating.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "core/calibration.h"
#include "core/image.h"

namespace striae::testing {

/// An invented rig at about 1 m on a quarter-size sensor, every distortion at work.
Calibration SmallQuarterRig();
/// The same at about 2 m.
Calibration LargeQuarterRig();

struct FringeScene {
  Calibration rig;
  /// Depth (mm) along a ray scaled to z = 1; nullopt where the ray meets nothing.
  std::function<std::optional<double>(const Eigen::Vector3d& ray)> depth;
  std::function<double(const Eigen::Vector3d& point)> albedo = [](const Eigen::Vector3d&) { return 0.6; };
  double ambient = 0.05;  ///< share of the flash's light that reaches what the grating does not light
  double noise = 0.002;   ///< sd, linear light
  std::uint32_t seed = 1;
};

/// The photograph, sRGB encoded to 8 bit.
Photograph Render(const FringeScene& scene);
/// True depth of every pixel, NaN where nothing is.
ImageF TrueDepth(const FringeScene& scene);

/// A plane before the camera: z = distance + slope_x x + slope_y y, within half_width_mm x half_height_mm.
std::function<std::optional<double>(const Eigen::Vector3d&)> Plane(double distance_mm, double slope_x, double slope_y,
                                                                   double half_width_mm = 1e4,
                                                                   double half_height_mm = 1e4);
/// A cylinder along y (an upright limb) whose front is at `distance_mm`.
std::function<std::optional<double>(const Eigen::Vector3d&)> UprightLimb(double distance_mm, double radius_mm);

}  // namespace striae::testing
