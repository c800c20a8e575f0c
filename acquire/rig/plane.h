// Flat test bodies: a plane, and the stepped reference plate of the paper's calibration.
#pragma once

#include "acquire/rig/mesh.h"

namespace striae::rig {

struct PlaneOptions {
  double distance_mm = 1000;              ///< depth on the camera's axis
  double half_size_mm = 400;              ///< half of its side
  double tilt_x_deg = 0, tilt_y_deg = 0;  ///< about the camera's x and y axes
  double albedo = 0.6;
};

/// A white square plate. Its points X satisfy n . (X - (0, 0, distance)) = 0 with n = Ry(tilt_y) Rx(tilt_x) (0, 0, -1).
TriangleMesh MakePlane(const PlaneOptions& options);
Eigen::Vector3d PlaneNormal(const PlaneOptions& options);

struct ReferencePlateOptions {
  double width_mm = 420, height_mm = 350;         ///< larger than the lit field: the grating's edges show on it
  double cap_radius_mm = 24, cap_height_mm = 12;  ///< spherical caps towards the camera, on a grid
  int columns = 6, rows = 5;
  double spacing_mm = 1;  ///< of the mesh
};

/// A plate with spherical caps, centred on the origin in its own frame: x right, y down, relief along -z (CONTRACT
/// "Steps"). Caps that would touch are a usage error of the caller (std::logic_error).
TriangleMesh MakeReferencePlate(const ReferencePlateOptions& options);

}  // namespace striae::rig
