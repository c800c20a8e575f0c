// The virtual skin: the ring of healthy skin continued across the wound, as a height w over the wound's frame.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "analysis/wound/detail/fairing.h"
#include "analysis/wound/detail/quadric.h"
#include "analysis/wound/detail/spline.h"

namespace striae::wound {

/// c2: quadratic height; c4: quartic height; q: quadric in space; q+c4: quadric, then a quartic on its residual; q+s:
/// quadric, then a smoothing spline on its residual; q+s+f: CGAL's fairing across the wound, from the rim that q+s
/// gives.
enum class SkinModel { kC2, kC4, kQuadric, kQuadricC4, kQuadricSpline, kFaired };
/// Those that compete for a wound, the usual one first.
inline constexpr std::array<SkinModel, 6> kSkinModels = {SkinModel::kQuadricC4,     SkinModel::kC4,
                                                         SkinModel::kQuadric,       SkinModel::kC2,
                                                         SkinModel::kQuadricSpline, SkinModel::kFaired};
std::string_view ToString(SkinModel model);

/// Wound frame: origin at the ring's centre, w towards the camera, lengths in mm.
struct Frame {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Matrix3d wound_from_camera = Eigen::Matrix3d::Identity();
  [[nodiscard]] Eigen::Vector3d FromCamera(const Eigen::Vector3d& point_in_camera) const {
    return wound_from_camera * (point_in_camera - origin);
  }
};

/// Plane through the points by repeated trimmed fits; w points to the camera.
Frame FitFrame(const std::vector<Eigen::Vector3d>& points_in_camera);

class Skin {
 public:
  SkinModel model = SkinModel::kC4;
  double radius_mm = 1;               ///< coordinates are divided by it before anything else
  std::optional<Quadric> quadric;     ///< the base of q, q+c4, q+s
  std::optional<Spline> spline;       ///< on top of them; q+s, q+s+f
  std::optional<FairedSheet> faired;  ///< on top of everything else; q+s+f
  int order = 4;
  Eigen::VectorXd coefficients;    ///< of Terms(), in units of radius_mm
  Eigen::MatrixXd inverse_normal;  ///< inverse of the weighted normal matrix of the coefficients
  double rms_mm = 0;               ///< weighted rms of the ring about this skin
  bool fell_back = false;          ///< q+c4 was asked for, but no quadric fits: this is c4

  [[nodiscard]] double Height(double u, double v) const;
  /// dw/du, dw/dv
  [[nodiscard]] Eigen::Vector2d Gradient(double u, double v) const;
  /// Monomials at (u, v): how the height depends on the coefficients (times radius_mm).
  [[nodiscard]] Eigen::VectorXd Terms(double u, double v) const;
};

/// Robust weights of ring points about their quartic patch (Huber, then Tukey's biweight), and their noise.
struct RingWeights {
  std::vector<double> weight;
  double noise_mm = 0;       ///< robust sd about the patch
  double outlier_share = 0;  ///< points that Tukey's biweight leaves out
};
RingWeights WeighRing(const std::vector<Eigen::Vector3d>& ring);

/// Fits a model to ring points in the wound's frame.
Skin FitSkin(SkinModel model, const std::vector<Eigen::Vector3d>& ring, const RingWeights& weights);

}  // namespace striae::wound
