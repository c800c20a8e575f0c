#include "acquire/rig/bust.h"

#include <Eigen/Geometry>

#include "acquire/rig/detail/bust_parts.h"
#include "acquire/rig/detail/dress.h"
#include "acquire/rig/detail/texture.h"

namespace striae::rig {
namespace {

constexpr double kNeckStart_mm = 22, kNeckEnd_mm = -38;  // below: moves with the torso; above: with the head

/// The neck's share of the head's rotation, by height: part of the way along the rotation.
void BendNeck(const Eigen::Matrix3d& head_rotation, TriangleMesh& neck) {
  const Eigen::Quaterniond still = Eigen::Quaterniond::Identity();
  const Eigen::Quaterniond turned(head_rotation);
  for (Eigen::Vector3d& v : neck.vertex) {
    v = still.slerp(detail::SmootherStep(kNeckStart_mm, kNeckEnd_mm, v.y()), turned) * v;
  }
  ComputeNormals(neck);
}

}  // namespace

TriangleMesh MakeBust(const BustOptions& options) {
  TriangleMesh head = detail::MakeHead(options.seed);
  TriangleMesh neck = detail::MakeNeck(options.seed);
  Append(detail::GrowHair(options.hair, options.seed, head), head);
  Move(options.head_rotation, Eigen::Vector3d::Zero(), head);
  BendNeck(options.head_rotation, neck);
  TriangleMesh bust = detail::MakeTorso(options.seed);
  detail::PutOnShirt(options.shirt, options.seed, bust);
  if (options.arm) Append(detail::MakeArm(options.seed), bust);
  Append(neck, bust);
  Append(head, bust);
  const Eigen::Vector3d pivot(0, options.pivot_y_mm, options.distance_mm);
  Move(options.torso_rotation, pivot + options.torso_shift_mm, bust);
  return bust;
}

}  // namespace striae::rig
