// Embree behind a small door: the first facet that a ray meets, and whether a point sees another.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "acquire/rig/mesh.h"
#include "core/result.h"

namespace striae::rig::detail {

struct Hit {
  std::uint32_t triangle = 0;
  float u = 0, v = 0;  ///< barycentric weights of the second and third vertex
  float place = 0;     ///< along the ray, in units of its direction
};

/// Safe to use from several threads at once. The mesh must outlive it.
class RayScene {
 public:
  static Result<RayScene> Build(const TriangleMesh& mesh);

  [[nodiscard]] std::optional<Hit> First(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const;
  /// Nothing lies between the two points.
  [[nodiscard]] bool Sees(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

 private:
  struct Embree;
  explicit RayScene(std::shared_ptr<const Embree> embree);
  std::shared_ptr<const Embree> embree_;
};

}  // namespace striae::rig::detail
