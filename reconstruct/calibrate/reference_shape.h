// The reference object of a calibration: a relief of known shape, as a height field z(x, y) in its own frame
// (mm; x right, y down, relief towards the camera along -z; CONTRACT "Steps").
#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/image.h"
#include "core/result.h"
#include "core/surface.h"

namespace striae::reconstruct {

/// Height field of a reference mesh, bilinear between the nodes of a fine grid.
class ReferenceShape {
 public:
  /// From a mesh with faces. `cells` is the number of grid nodes along the longer side. kBadFile for a mesh without
  /// faces, extent or relief (a flat plate cannot tell the parameters apart).
  static Result<ReferenceShape> FromMesh(const Surface& mesh, int cells = 1600);

  /// A node-interpolated height with its slopes.
  struct Height {
    double z = 0, dz_dx = 0, dz_dy = 0;
    bool usable = true;  ///< false near steps and the mesh's border, where a photograph's phase is not the shape's
  };
  /// nullopt outside of the mesh.
  [[nodiscard]] std::optional<Height> At(double x, double y) const;

  [[nodiscard]] const Eigen::Vector3d& lowest() const { return lowest_; }    ///< bounding box, mm
  [[nodiscard]] const Eigen::Vector3d& highest() const { return highest_; }  ///< bounding box, mm

 private:
  ReferenceShape() = default;
  void MarkSteps();

  Eigen::Vector3d lowest_, highest_;
  double spacing_mm_ = 0;
  ImageF height_;  ///< NaN where the mesh has no surface
  Mask usable_;
};

}  // namespace striae::reconstruct
