// Light from one sample of the scene, and from one pixel as the mean over its area.
#pragma once

#include <memory>
#include <optional>

#include "acquire/rig/detail/ray_scene.h"
#include "acquire/rig/render.h"
#include "core/optics.h"

namespace striae::rig::detail {

/// What the ray of a pixel's centre meets.
struct Sample {
  bool hit = false;
  bool sees_light = false;
  double depth_mm = 0;
  Hit where;
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();  ///< z = 1
};

class Shader {
 public:
  Shader(const TriangleMesh& mesh, const RayScene& scene, const Calibration& calibration, const LightOptions& options);

  /// The same with the body `shift_mm` further: camera and projector stay, and so do the stripes.
  [[nodiscard]] Shader Shifted(const Eigen::Vector3d& shift_mm) const;

  [[nodiscard]] Sample Trace(const Eigen::Vector2d& pixel) const;
  /// Linear RGB of a pixel whose surroundings are one smooth facet: the facet's plane stands for all of its area.
  /// `across` and `along` are the changes of the ray from this pixel to the next across and along the stripes.
  [[nodiscard]] Eigen::Vector3f Smooth(const Sample& centre, const Eigen::Vector3d& across,
                                       const Eigen::Vector3d& along) const;
  /// Linear RGB of a pixel at an edge: a fixed pattern of traced rays.
  [[nodiscard]] Eigen::Vector3f Edge(const Eigen::Vector2d& pixel) const;
  /// Stripe order at the sample when the grating's light reaches it, bright stripe or dark.
  [[nodiscard]] std::optional<double> LitOrder(const Sample& sample) const;
  [[nodiscard]] bool AlongRows() const { return calibration_.direction == StripeDirection::kHorizontal; }

 private:
  struct Plane {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< not normalised
    double offset = 0;
  };
  [[nodiscard]] Plane PlaneOf(std::uint32_t triangle) const;
  /// Mean over the pixel's area of the grating's light, times the painted albedo where something is painted.
  [[nodiscard]] Eigen::Vector3f Painted(const Sample& centre, const Plane& plane, const Eigen::Vector3d& across,
                                        const Eigen::Vector3d& along, double direct, double blur,
                                        const Eigen::Vector3f& skin) const;

  const TriangleMesh& mesh_;
  const RayScene& scene_;
  Eigen::Vector3d shift_mm_ = Eigen::Vector3d::Zero();  ///< of the body in the camera frame
  Calibration calibration_;
  StripeOptics optics_;
  int stripes_;
  LightOptions options_;
  std::shared_ptr<const GratingLight> grating_;
  ProjectorLight projector_;
};

}  // namespace striae::rig::detail
