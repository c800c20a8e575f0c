// Photographs of several bodies at once, by formulas alone: what hides what, which shadow falls where, what is dark.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/calibration.h"
#include "core/image.h"

namespace striae::testing {

/// A unit ball, a unit tube (x^2 + z^2 = 1, |y| < 1, open ends) or a unit square (z = 0, |x|, |y| < 1), placed by an
/// affine map.
struct Body {
  enum class Kind { kBall, kTube, kSquare };
  Kind kind = Kind::kBall;
  Eigen::Affine3d camera_from_unit = Eigen::Affine3d::Identity();
  /// Of a point in the unit shape's frame.
  std::function<double(const Eigen::Vector3d&)> albedo = [](const Eigen::Vector3d&) { return 0.6; };
};

/// A ball of these half axes, a tube along the local y of these radii (x, z) and half length (y), or a square of half
/// sides (x, y): at `center` (mm, camera frame) and turned.
Body Placed(Body::Kind kind, const Eigen::Vector3d& center, const Eigen::Vector3d& half_axes,
            const Eigen::Matrix3d& turned = Eigen::Matrix3d::Identity());

struct BodyScene {
  Calibration rig;
  std::vector<Body> bodies;
  double flash = 0.75;     ///< linear value of a white body that faces a bright stripe at the middle distance
  double ambient = 0.012;  ///< of a white body under the room's light
  double leak = 0.02;      ///< share of the flash that the dark stripes let through
  double softness = 0.09;  ///< of the stripes' edges, stripes
  double noise = 0.002;    ///< sd at linear value 0.1; grows with the root of the light
  std::uint32_t seed = 1;
};

/// 8 bit, sRGB.
Photograph PhotographOf(const BodyScene& scene);
/// True depth at every pixel's centre, mm; NaN where nothing is.
ImageF DepthOf(const BodyScene& scene);

}  // namespace striae::testing
