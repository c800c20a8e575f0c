// A printed ArUco label on a body: a target of known size, so that photographs of it test how a size gives a distance.
#pragma once

#include <array>

#include "acquire/rig/mesh.h"
#include "core/result.h"

namespace striae::rig {

struct LabelOptions {
  int id = 0;                ///< of DICT_4X4_1000, 0..999
  double side_mm = 40;       ///< of the marker's black square; white paper of a sixth of it stands out on every side
  double x_mm = 0, y_mm = 0; /**< camera frame: the label's middle is where the line with this x and y, parallel to the
                                  camera's axis, first meets the body */
  double turn_deg = 0;       ///< in its plane, clockwise as the camera sees it
};

struct LabelTruth {
  /// The black square's corners on the surface, camera frame, mm: upper left, upper right, lower right, lower left of
  /// the unturned marker, the order in which ArUco detectors give them.
  std::array<Eigen::Vector3d, 4> corner_in_camera;
};

/// Paints the label onto the body (camera frame). It is printed square on the plane that touches the surface in the
/// label's middle and pressed on along that plane's normal: on a plane every side is side_mm; on a limb two corners at
/// the same height lie side_mm apart. kUsage for an id outside 0..999, a side that is not positive, or where the body
/// ends within the label.
Result<LabelTruth> PaintLabel(const LabelOptions& options, TriangleMesh& mesh);

}  // namespace striae::rig
