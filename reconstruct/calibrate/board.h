// Calibration without a machined object: a printed ChArUco board, photographed under the stripes at about twelve poses.
// Its corners give camera and poses; with the planes known, the stripes' orders on them give the projector.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/calibration.h"
#include "core/result.h"
#include "core/target.h"
#include "reconstruct/calibrate/solve.h"
#include "reconstruct/phase.h"

namespace striae::reconstruct {

/// An inner corner of the chessboard.
struct BoardCorner {
  Eigen::Vector2d pixel;
  Eigen::Vector2d on_board_mm;  ///< from the board's upper left corner; x right, y down, seen from the front
};

/// Orders of one connected sheet; its whole number is its own.
struct OrderSheet {
  std::vector<OrderSample> samples;
};

/// One photograph of the board.
struct BoardView {
  std::vector<BoardCorner> corners;
  std::vector<OrderSheet> sheets;                         ///< largest first
  std::optional<double> low_edge_order, high_edge_order;  ///< of the first sheet, as in CalibrationView
};

/// Finds the corners on the stripe-free background (ArUco; Garrido-Jurado et al., Pattern Recognition 47, 2014) and
/// samples the sheets. kBadCalibration when fewer than eight corners are seen.
Result<BoardView> ViewOfBoard(const PhaseResult& phase, const CharucoBoard& board);

struct BoardViewFit {
  int whole_stripes = 0;
  double offset_before_rounding = 0;
  double sd_stripes = 0, sd_mm = 0;  ///< of the first sheet's samples against the board's plane
  double corner_rms_px = 0;
  int samples = 0, corners = 0;
  double distance_mm = 0, tilt_deg = 0;  ///< of the board's middle; of its normal against the optical axis
};

struct BoardFit {
  Calibration calibration;
  std::vector<BoardViewFit> views;
  double sd_mm = 0, robust_sd_mm = 0;  ///< depth differences to the planes over all samples
  double corner_rms_px = 0;
  bool order_is_absolute = false;
  std::vector<CalibrationFit::Parameter> parameters;
  std::vector<CalibrationFit::Correlation> correlations;
};

/// Camera, projector and poses from all photographs together. kBadCalibration with the reason: fewer than five
/// photographs, all at one distance and tilt, orders that do not settle on whole numbers, corners or orders that do not
/// lie on a plane, parameters far from any rig.
Result<BoardFit> SolveWithBoard(const std::vector<BoardView>& views, const CharucoBoard& board,
                                const NominalRig& nominal);

}  // namespace striae::reconstruct
