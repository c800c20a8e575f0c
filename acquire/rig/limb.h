// A calf-like limb with a carved crater whose volume, areas and depth follow from formulas, not from a mesh.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "acquire/rig/mesh.h"
#include "core/result.h"

namespace striae::rig {

/// A wound: its outline on the skin is an ellipse made irregular, its depth along the limb's radius
/// d = depth (1 - rho^wall)^2, rho = 0 in the middle and 1 on the outline; there it runs out smoothly.
struct CraterOptions {
  double depth_mm = 8;
  double radius_mm = 22;       ///< half width across the limb, along the skin
  double elongation = 1.3;     ///< half length along the limb over half width
  double irregularity = 0.08;  ///< relative, third order in the angle
  double wall = 6;             ///< the higher, the steeper the wall and the flatter the bed; at least 2
  double angle_deg = 4;        ///< where on the limb: 0 faces the camera
  double along_mm = 8;         ///< and down its axis from the middle
};

struct LimbOptions {
  double distance_mm = 1000;  ///< depth of the skin in the middle
  double radius_mm = 52;
  double length_mm = 460;  ///< longer than the lit field, so that the grating's edges show
  double lean_deg = 5;     ///< in the image, about the camera's z
  double pitch_deg = 3;    ///< about the camera's x
  CraterOptions crater;
  unsigned seed = 1;  ///< of the skin's mottling
};

/// What the measurements should find. Volumes and areas are integrals of the defining formulas.
struct WoundTruth {
  double volume_ml = 0;
  double skin_area_cm2 = 0;                        ///< of the healthy skin that the outline encloses
  double bed_area_cm2 = 0;                         ///< of the carved surface
  double max_depth_mm = 0;                         ///< largest distance of the bed from the healthy skin
  std::vector<Eigen::Vector3d> outline_in_camera;  ///< on the skin, mm
};

struct Limb {
  TriangleMesh mesh;  ///< in the camera frame
  WoundTruth truth;
};

/// Radius of the healthy limb, mm, at the angle (0 faces the camera, positive to x) and the place down its axis.
double LimbRadius(const LimbOptions& options, double angle_rad, double along_mm);
/// Radial depth of the crater there; 0 outside of its outline.
double CraterDepth(const LimbOptions& options, double angle_rad, double along_mm);

/// kUsage when the crater does not fit onto the limb's visible side.
Result<Limb> MakeLimb(const LimbOptions& options);

}  // namespace striae::rig
