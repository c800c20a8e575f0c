// Bodies with a crater of exactly known volume, seen by a pinhole camera: truth from geometry alone.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/outline.h"
#include "core/surface.h"

namespace striae::testing {

/// A body of revolution about the camera's y direction (or a plate), its front `distance_mm` from the camera, with
/// a dent of depth D (1 - rho^2 / a^2), rho measured along the body's skin (s = angle x front radius, y along it).
struct Body {
  double radius_mm = 50;               ///< at the front, height y = 0; a plate when 0
  double taper = 0, bulge_per_mm = 0;  ///< radius(y) = radius (1 + taper y / radius + bulge y^2 / radius)
  double crater_radius_mm = 15, crater_depth_mm = 6;  ///< a negative depth is proud tissue
  double rim_mm = 0, rim_decay_mm = 8;                ///< swelling outside the crater: height x exp(-(rho - a) / decay)
  double distance_mm = 1000;
  double turn_rad = 0;  ///< the crater's place, off the front by this angle about the axis
  double tilt_rad = 0;  ///< the body's axis (a plate: its normal) leans towards the camera

  [[nodiscard]] double Depth(double s_mm, double y_mm) const;
  [[nodiscard]] double RadiusAt(double y_mm) const;
  /// By definition: integral of (R^2 - (R - d)^2) / 2 over angle and height; closed form on plate and cylinder.
  [[nodiscard]] double CraterVolumeMm3() const;
  /// The same, net of swelling, within rho < `rho_mm`, by quadrature.
  [[nodiscard]] double NetVolumeMm3(double rho_mm) const;
};

struct Camera {
  int width = 400, height = 400;
  double focal_px = 3000;  ///< 1/3 mm a pixel at 1 m
};

struct Noise {
  double white_mm = 0;       ///< along the ray, each pixel on its own
  double correlated_mm = 0;  ///< smooth over about `length_px`
  double length_px = 12;
  std::uint32_t seed = 1;
};

/// What the camera sees of the body: one vertex per pixel that meets it; no faces.
Surface Observe(const Body& body, const Camera& camera, const Noise& noise = {});
/// The circle of radius `radius_mm` around the crater's middle on the uncarved skin, in sensor pixels.
Outline CircleOn(const Body& body, const Camera& camera, double radius_mm, int points = 96);

/// Every vertex for which `keep` (col, row) is true.
Surface Keep(const Surface& surface, const std::function<bool(int, int)>& keep);

}  // namespace striae::testing
