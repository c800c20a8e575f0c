// The rig's parameters, and their JSON form (CONTRACT "Calibration").
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/hex.h"
#include "core/result.h"

namespace striae {

/// Pinhole camera with OpenCV's distortion (undistorted to distorted). Pixels; integer = pixel centre.
struct CameraModel {
  double fx = 0, fy = 0, cx = 0, cy = 0;
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0;
};

/// The grating projector. Pinhole: a flat grating behind a lens. Angular: the paper's fan of equally spaced planes.
struct ProjectorModel {
  enum class Kind { kPinhole, kAngular };
  Kind kind = Kind::kPinhole;
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();           ///< in the camera frame
  Eigen::Vector3d rotation_rodrigues = Eigen::Vector3d::Zero();  ///< camera to projector, rad; pinhole only
  double focal_stripes = 0;                                      ///< focal length over grating period; pinhole only
  double center_order = 0;                                       ///< stripe order on the projector's axis; pinhole only
  double k1 = 0;                       ///< radial distortion, ideal to distorted mask coordinate; pinhole only
  double a0_rad = 0, delta_a_rad = 0;  ///< angle of order 0 and per order, positive downwards; angular only
};

/// Which way the stripes run on the sensor: horizontal = along rows (order grows with the row).
enum class StripeDirection { kHorizontal, kVertical };
std::string_view ToString(StripeDirection direction);

struct CalibrationSource {
  Sha256 sha256;
  double position_mm = 0;
};

/// How well a calibration determined its parameters: their joint covariance, so that anything computed from them can
/// carry a standard uncertainty (J covariance J^T, J by CalibrationParameter and differences).
struct CalibrationUncertainty {
  std::vector<std::string> names;  ///< of the parameters as CalibrationParameter knows them; each once
  Eigen::MatrixXd covariance;      ///< symmetric, in the order of `names`; units px, mm, rad, stripes
};

struct Calibration {
  int image_width_px = 0, image_height_px = 0;
  CameraModel camera;
  ProjectorModel projector;
  std::optional<int> stripes;  ///< number of stripes of the grating; without it no order comes from the grating's edge
  StripeDirection direction = StripeDirection::kHorizontal;
  double near_mm = 0, far_mm = 0;  ///< working distance along z
  struct Quality {
    double sd_mm = 0;
    int photographs = 0;
  };
  std::optional<Quality> quality;
  std::vector<CalibrationSource> sources;
  std::optional<CalibrationUncertainty> uncertainty;
};

/// The field of that name, or nullptr: "camera.fx", fy, cx, cy, k1, k2, p1, p2; "projector.center_x", center_y,
/// center_z (mm); pinhole: "projector.rotation_x", rotation_y, rotation_z (Rodrigues, rad), focal_stripes,
/// center_order, k1; angular: "projector.a0_rad", delta_a_rad.
double* CalibrationParameter(Calibration& calibration, std::string_view name);

/// Reads striae-calibration/1. kBadCalibration with the offending field for anything missing, given twice, not finite
/// or absurd.
Result<Calibration> CalibrationFromJson(std::string_view text);
/// Pretty-printed, doubles with round-trip precision.
std::string ToJsonText(const Calibration& calibration);

}  // namespace striae
