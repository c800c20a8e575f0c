// Rigid registration of a patch to a whole capture: point to plane, weighted and robust, with a normal gate. The
// adapter to PCL; no PCL type stands here.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "analysis/head/detail/cloud.h"
#include "core/result.h"

namespace striae::head::detail {

/// Normals from the plane through all neighbours within `radius_mm`, towards the camera; points with fewer than six
/// neighbours are left out. Surfaces from PCL's NormalEstimation. kInternal if PCL fails.
Result<Cloud> WithNormals(const Thinned& points, double radius_mm);

/// A point of the patch (after the motion) and its counterpart with the mean of both normals, in the target's frame.
struct Pair {
  Eigen::Vector3d moved, target, normal;
  double weight = 1;  ///< in the last least squares: inverse variance times how well it agrees with the rest
  [[nodiscard]] double ToPlane() const { return normal.dot(moved - target); }
};

/// How well a patch lies on the target.
struct Fit {
  Eigen::Isometry3d target_from_patch = Eigen::Isometry3d::Identity();
  std::vector<Pair> pairs;  ///< within the gates; what disagrees with the rest has no weight
  double residual_mm = 0;   ///< root mean square of ToPlane over the best nine tenths of the pairs
  double noise_mm = 0;      ///< median of the pairs' standard uncertainties, both points', as the surfaces state them
  double overlap = 0;       ///< share of the patch's visible points with a counterpart within the gates
  double agreement = 0;     ///< mean share of their weight that the pairs keep in the robust least squares
  double visible = 0;       ///< share of the patch's points that face the camera after the motion, within the field
  double loss = 1;          ///< mean over all points of the patch of min(1, (distance / gate)^2): compares starts
  double rival_loss = 1;    ///< of the best other motion, more than 5 degrees away, that the starts led to
};

/// One stage: counterparts within `distance_mm` whose normals differ by at most `normals_deg`; at most `iterations`.
/// Far from the solution every pair counts the same and the worst tenth is trimmed. `robust`: inverse variances and
/// Tukey's biweight, so that jaw, hair and what the Fourier window rounds do not pull.
struct Stage {
  double distance_mm;
  double normals_deg;
  int iterations;
  bool robust = false;
};

/// A capture prepared for many registrations.
class Target {
 public:
  explicit Target(Cloud cloud);
  ~Target();
  Target(Target&&) noexcept;
  Target& operator=(Target&&) noexcept;

  /// Least squares through the stages, coarse to fine. Fewer than 50 counterparts end a stage: Judge shows it.
  [[nodiscard]] Eigen::Isometry3d Align(const Cloud& patch, const Eigen::Isometry3d& start,
                                        std::span<const Stage> stages) const;
  /// Counterparts within `distance_mm` and 35 degrees of normals at a given motion.
  [[nodiscard]] Fit Judge(const Cloud& patch, const Eigen::Isometry3d& target_from_patch, double distance_mm) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace striae::head::detail
