// OpenCV's part of the board calibration, kept in one file.
#pragma once

#include <vector>

#include "core/image.h"
#include "reconstruct/calibrate/board.h"

namespace striae::reconstruct::detail {

/// Corners of the board on a stripe-free picture (linear light). Empty when no marker is found.
Result<std::vector<BoardCorner>> FindBoardCorners(const ImageF& background, const CharucoBoard& board);

/// Pose of the board from its corners: Rodrigues vector and translation, board to camera.
struct BoardPose {
  double values[6] = {};
};
Result<BoardPose> PoseFromCorners(const std::vector<BoardCorner>& corners, const CameraModel& camera);

}  // namespace striae::reconstruct::detail
